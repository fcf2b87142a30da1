// Files: saving, a file that changes on disk, watching, and the doors that stay shut.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { request } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { after, describe, test } from 'node:test';
import { dapple, endBrowser, open, serve, settled, skip, text } from './harness.mjs';

function folder() {
  const made = mkdtempSync(join(tmpdir(), 'dapple-files-'));
  writeFileSync(join(made, 'mine.toml'), dapple('recipe', 'clouds'));
  return made;
}

/** The status of a request with these headers. */
function status(url, path, headers) {
  const { hostname, port } = new URL(url);
  return new Promise((done, fail) => {
    const asked = request({ hostname, port, path, headers }, (answer) => {
      answer.resume();
      done(answer.statusCode);
    });
    asked.on('upgrade', (answer, socket) => {
      socket.destroy();
      done(101);
    });
    asked.on('error', fail);
    asked.end();
  });
}

describe('files', { skip, timeout: 120_000 }, () => {
  after(endBrowser);

  test('a recipe is saved, and what changed on disk is not replaced unasked', async () => {
    const studio = await serve(['mine.toml'], 'studio', folder());
    try {
      const page = await open(studio.url);
      await settled(page);
      await page.getByRole('spinbutton', { name: 'Seed', exact: true }).fill('77');
      await page.keyboard.press('Tab');
      await settled(page);
      await page.keyboard.press('Control+s');
      await page.locator('dialog').getByRole('button', { name: 'Save', exact: true }).click();
      await page.locator('dialog').waitFor({ state: 'detached' });
      assert.equal(readFileSync(join(studio.folder, 'mine.toml'), 'utf8'), await text(page));
      assert.equal(await page.locator('.top .dot').count(), 0);
      await page.getByRole('spinbutton', { name: 'Seed', exact: true }).fill('78');
      await page.keyboard.press('Tab');
      await settled(page);
      const other = `${readFileSync(join(studio.folder, 'mine.toml'), 'utf8')}\n# By somebody else.\n`;
      writeFileSync(join(studio.folder, 'mine.toml'), other);
      await page.getByRole('button', { name: 'Keep mine' }).click();
      await page.keyboard.press('Control+s');
      await page.locator('dialog').getByRole('button', { name: 'Save', exact: true }).click();
      await page.locator('dialog [role=alert]').waitFor();
      assert.equal(readFileSync(join(studio.folder, 'mine.toml'), 'utf8'), other);
      await page.getByRole('button', { name: 'Replace what is on disk' }).click();
      await page.locator('dialog').waitFor({ state: 'detached' });
      assert.equal(readFileSync(join(studio.folder, 'mine.toml'), 'utf8'), await text(page));
      assert.deepEqual(page.wrong, []);
    } finally {
      studio.end();
    }
  });

  test('changes that were not saved are there again after a reload', async () => {
    const studio = await serve(['mine.toml'], 'studio', folder());
    try {
      const page = await open(studio.url);
      await settled(page);
      page.on('dialog', (dialog) => dialog.accept());
      await page.getByRole('spinbutton', { name: 'Seed', exact: true }).fill('4711');
      await page.keyboard.press('Tab');
      await settled(page);
      const before = await text(page);
      await page.waitForTimeout(500);
      await page.reload();
      await settled(page);
      await page.waitForFunction(() => document.querySelector('[aria-label=Seed]')?.value === '4711');
      assert.equal(await text(page), before);
    } finally {
      studio.end();
    }
  });

  test('a page that lost its way goes on with its own text', async () => {
    const studio = await serve(['mine.toml'], 'studio', folder());
    try {
      const page = await open('about:blank');
      let way;
      await page.routeWebSocket(/\/ws/, (socket) => {
        way = socket;
        socket.connectToServer();
      });
      await page.goto(studio.url);
      await settled(page);
      await page.getByRole('spinbutton', { name: 'Seed', exact: true }).fill('31');
      await page.keyboard.press('Tab');
      await settled(page);
      const before = await text(page);
      const lost = way;
      await lost.close();
      await page.waitForTimeout(2500);
      assert.notEqual(way, lost);
      assert.equal(await text(page), before);
      await page.getByRole('button', { name: 'Shuffle the seed' }).click();
      await settled(page);
      assert.notEqual(await text(page), before);
    } finally {
      studio.end();
    }
  });

  test('a page goes on with its own text in another run, whose address is pasted into its tab', async () => {
    const first = await serve(['mine.toml'], 'studio', folder());
    const { port } = new URL(first.url);
    let second;
    try {
      const page = await open(first.url);
      await settled(page);
      await page.getByRole('spinbutton', { name: 'Seed', exact: true }).fill('31');
      await page.keyboard.press('Tab');
      await settled(page);
      const before = await text(page);
      first.child.removeAllListeners('exit');
      first.child.kill();
      await page.getByText('run it again with the same --port').waitFor();
      second = await serve(['--port', port, 'mine.toml'], 'studio', first.folder);
      await page.getByText('paste the address that it printed').waitFor();
      assert.equal(await text(page), before);
      await page.evaluate((url) => void (location.href = url), second.url);
      await page.locator('.status .bad').waitFor({ state: 'detached' });
      await settled(page);
      assert.equal(await text(page), before);
      assert.equal(new URL(page.url()).hash, '', 'the secret leaves the address');
      await page.getByRole('button', { name: 'Shuffle the seed' }).click();
      await settled(page);
      assert.notEqual(await text(page), before);
    } finally {
      first.end();
      second?.end();
    }
  });

  test('a file that leads to the address opens the page', async () => {
    const studio = await serve(['mine.toml'], 'studio', folder());
    const way = join(studio.folder, 'way.html');
    try {
      writeFileSync(way, `<!doctype html><meta http-equiv=refresh content="0;url=${studio.url}">`);
      const page = await open(pathToFileURL(way).href);
      await page.waitForURL(/^http/);
      await settled(page);
    } finally {
      studio.end();
    }
  });

  test('a watched file is followed and cannot be changed', async () => {
    const studio = await serve(['mine.toml'], 'watch', folder());
    try {
      const page = await open(studio.url);
      await settled(page);
      assert.equal(await page.locator('.reading').count(), 1);
      assert.equal(await page.locator('.parameters input:enabled').count(), 0);
      const next = readFileSync(join(studio.folder, 'mine.toml'), 'utf8').replace(/seed = \d+/, 'seed = 12345');
      writeFileSync(join(studio.folder, 'mine.toml'), next);
      await page.waitForFunction(() => document.querySelector('.text .editor').shadowRoot.querySelector('.cm-content').textContent.includes('seed = 12345'));
      await settled(page);
      assert.equal(await text(page), next);
      assert.deepEqual(page.wrong, []);
    } finally {
      studio.end();
    }
  });

  test('a wrong token, Host or Origin gets 403', async () => {
    const studio = await serve(['flagstone']);
    try {
      const { origin, host, hash } = new URL(studio.url);
      const token = hash.replace(/^#(t=)?/, '');
      const upgrade = { Connection: 'Upgrade', Upgrade: 'websocket', 'Sec-WebSocket-Version': '13', 'Sec-WebSocket-Key': 'MDEyMzQ1Njc4OWFiY2RlZg==' };
      assert.equal(await status(studio.url, `/ws?t=${token}`, { ...upgrade, Host: host, Origin: origin }), 101);
      assert.equal(await status(studio.url, '/ws?t=0123', { ...upgrade, Host: host, Origin: origin }), 403);
      assert.equal(await status(studio.url, `/ws?t=${token}`, { ...upgrade, Host: host, Origin: 'http://example.com' }), 403);
      assert.equal(await status(studio.url, `/ws?t=${token}`, { ...upgrade, Host: host }), 403);
      assert.equal(await status(studio.url, '/', { Host: 'example.com' }), 403);
      assert.equal(await status(studio.url, '/', { Host: host, 'Sec-Fetch-Site': 'cross-site' }), 403);
      assert.equal(await status(studio.url, '/export/1/x.png', { Host: host }), 403);
      assert.equal(await status(studio.url, '/', { Host: host }), 200);
    } finally {
      studio.end();
    }
  });
});
