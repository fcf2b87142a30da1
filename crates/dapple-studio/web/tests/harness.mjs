// What the tests share: the real command in a folder of its own, a Chromium, and a page.
//
// DAPPLE is the command (by default target/debug/dapple of the workspace), DIST the built page (by default ../dist),
// CHROMIUM the browser. Where the command or the browser is missing the tests are skipped, with a message.
import { execFileSync, spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const here = fileURLToPath(new URL('.', import.meta.url));
export const DAPPLE = resolve(process.env.DAPPLE ?? join(here, '../../../../target/debug/dapple'));
export const DIST = resolve(process.env.DIST ?? join(here, '../../dist'));
const CHROMIUM = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find((path) => path && existsSync(path));

/** Why the tests cannot run, or false. */
export const skip =
  (!CHROMIUM && 'skipped: no Chromium; name one by CHROMIUM') ||
  (!existsSync(DAPPLE) && `skipped: no command at ${DAPPLE}; name one by DAPPLE`) ||
  (!existsSync(join(DIST, 'index.html')) && `skipped: the page is not built at ${DIST}; run npm run build`);

/** The page without a server, as `cargo xtask web` builds it; it is tested where STATIC names it. */
export const STATIC = process.env.STATIC ?? '';
export const skipStatic =
  (STATIC === '' && 'skipped: STATIC names no folder of `cargo xtask web`') ||
  (!CHROMIUM && 'skipped: no Chromium; name one by CHROMIUM') ||
  (!existsSync(DAPPLE) && `skipped: no command at ${DAPPLE}; name one by DAPPLE`);

/** A studio that runs: its folder, its address, and how to end it. */
export async function serve(args = [], command = 'studio', folder = mkdtempSync(join(tmpdir(), 'dapple-studio-'))) {
  const child = spawn(DAPPLE, [command, '--no-open', '--dist', DIST, ...args], { cwd: folder });
  let said = '';
  const url = await new Promise((done, fail) => {
    const late = setTimeout(() => fail(new Error(`no address was printed: ${said}`)), 20_000);
    const read = (data) => {
      said += data;
      const found = said.match(/http:\/\/\S+/);
      if (!found) return;
      clearTimeout(late);
      done(found[0]);
    };
    child.stdout.on('data', read);
    child.stderr.on('data', read);
    child.on('exit', () => fail(new Error(`the studio ended: ${said}`)));
  });
  const end = () => {
    child.kill();
    rmSync(folder, { recursive: true, force: true });
  };
  return { folder, url, end, child };
}

let browser = null;

/** A page on an address; throws at the end of the test what the page threw. */
export async function open(url, options = {}) {
  browser ??= await chromium.launch({
    executablePath: CHROMIUM,
    args: ['--no-sandbox', '--disable-gpu', '--enable-unsafe-swiftshader', '--disable-background-networking'],
  });
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.wrong = [];
  page.on('pageerror', (error) => page.wrong.push(String(error)));
  page.on('console', (message) => message.type() === 'error' && page.wrong.push(message.text()));
  await page.goto(url);
  return page;
}

/** Waits until the full pictures of the newest text are there. */
export async function settled(page, limit = 20_000) {
  await page.waitForFunction(() => {
    return document.querySelector('.page')?.dataset.settled === 'true';
  }, null, { timeout: limit });
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

/** Selects a node in the graph by keys. */
export async function select(page, name) {
  await page.locator(`.svelte-flow__node[data-id="${name}"]`).focus();
  await page.keyboard.press('Enter');
  await page.waitForFunction((name) => document.querySelector('.parameters .name')?.value === name, name);
}

export async function endBrowser() {
  await browser?.close();
  browser = null;
}

/** The pixels of a map as it is drawn, as one number. */
export function hash(page, map) {
  return page.evaluate((name) => {
    const canvas = document.querySelector(`canvas[data-map=${name}]`);
    const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
    let sum = 0;
    for (const byte of data) sum = (Math.imul(sum, 31) + byte) | 0;
    return sum;
  }, map);
}

/** The text in the editor. */
export function text(page) {
  return page.evaluate(() => {
    const content = document.querySelector('.text .editor').shadowRoot.querySelector('.cm-content');
    return content.cmTile?.view?.state.doc.toString() ?? content.cmView?.view?.state.doc.toString();
  });
}

/** The schema of recipes that the page has: that of `dapple recipe --schema`, without references to parameters. */
export function pageSchema() {
  const plain = (value) => {
    if (Array.isArray(value)) return value.map(plain);
    if (typeof value !== 'object' || value === null) return value;
    const [first, second] = value.anyOf ?? [];
    const { anyOf: _, ...others } = value;
    const inner = second?.$ref === '#/$defs/Reference' ? { ...first, ...others } : value;
    return Object.fromEntries(Object.entries(inner).map(([key, one]) => [key, plain(one)]));
  };
  return plain(JSON.parse(execFileSync(DAPPLE, ['recipe', '--schema'], { maxBuffer: 1 << 26 }).toString()));
}

/** What the command prints or writes. */
export function dapple(...args) {
  return execFileSync(DAPPLE, args, { encoding: 'utf8' });
}
