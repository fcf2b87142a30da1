// Shares recipes outside of the page: as a file, or as a link that contains the text.

const TEXT = '#toml=';

/** Downloads a text as a file. */
export function download(text: string, file: string): void {
  const url = URL.createObjectURL(new Blob([text], { type: 'application/toml' }));
  Object.assign(document.createElement('a'), { href: url, download: file }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/** Returns a link to this page that contains a compressed text. */
export async function linkTo(text: string): Promise<string> {
  const bytes = new Uint8Array(await through(new CompressionStream('deflate-raw'), text).arrayBuffer());
  const letters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('');
  const code = btoa(letters).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
  return location.origin + location.pathname + TEXT + code;
}

/** Returns the text in the fragment of a link, or null if there is none. */
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
