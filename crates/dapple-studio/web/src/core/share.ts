// Recipes that leave the page: as a file, or as an address that holds the text.

const TEXT = '#toml=';

/** Has the browser save a text. */
export function download(text: string, file: string): void {
  const url = URL.createObjectURL(new Blob([text], { type: 'application/toml' }));
  Object.assign(document.createElement('a'), { href: url, download: file }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/** The address of this page with a text in it, compressed. */
export async function linkTo(text: string): Promise<string> {
  const bytes = new Uint8Array(await through(new CompressionStream('deflate-raw'), text).arrayBuffer());
  const letters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('');
  const code = btoa(letters).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
  return location.origin + location.pathname + TEXT + code;
}

/** The text that the fragment of an address holds; null for another fragment. */
export async function textOf(fragment: string): Promise<string | null> {
  if (!fragment.startsWith(TEXT)) return null;
  try {
    const letters = atob(fragment.slice(TEXT.length).replaceAll('-', '+').replaceAll('_', '/'));
    const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
    return await through(new DecompressionStream('deflate-raw'), bytes).text();
  } catch {
    return null;
  }
}

function through(stream: CompressionStream | DecompressionStream, part: BlobPart): Response {
  return new Response(new Blob([part]).stream().pipeThrough(stream));
}
