// What an artist does first: sliders, deleting nodes, own models, comparing, saving under another name, exporting.
import assert from 'node:assert/strict';
import { mkdtempSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, describe, test } from 'node:test';
import { endBrowser, open, select, serve, settled, skip, text } from './harness.mjs';

/** A recipe with cells of two sizes, and one that costs much. */
const RECIPE = `dapple = 1
extent = [4, 4]

[nodes.base.noise]
basis = "gradient"
frequency = 1.5

[nodes.cells.worley]
frequency = 0.5

[nodes.fine.pups.octaves]

[nodes.sum]
add = ["base", "cells"]

[material]
height = "sum"
albedo = "fine"
`;

/** What somebody searches who does not know the names of nodes. */
const WORDS = [
  'voronoi', 'cellular', 'perlin', 'fbm', 'turbulence', 'ridged', 'brick', 'hexagon', 'fabric', 'stripes', 'checker', 'circle', 'square', 'dots', 'sdf',
  'pebbles', 'scratches', 'cracks', 'wood grain', 'leather', 'animal', 'curve', 'blur', 'emboss', 'levels', 'histogram scan', 'tint', 'hsv', 'desaturate',
  'gradient map', 'colorize', 'blend', 'merge', 'mask', 'invert', 'posterize', 'edge detect', 'edge wear', 'ao', 'erosion', 'swirl', 'rotate', 'modulo',
];

function folder(recipe = RECIPE) {
  const made = mkdtempSync(join(tmpdir(), 'dapple-artist-'));
  writeFileSync(join(made, 'mine.toml'), recipe);
  return made;
}

/** Runs `then` with the page of a studio, and expects that the page threw nothing. */
async function within(recipe, then) {
  const studio = await serve(['mine.toml'], 'studio', folder(recipe));
  try {
    const page = await open(studio.url);
    await settled(page);
    await then(page, studio);
    assert.deepEqual(page.wrong, []);
    await page.context().close();
  } finally {
    studio.end();
  }
}

/** Clicks into a slider at a fraction of its width. */
async function click(page, path, at) {
  const slider = page.locator(`[data-path="${path}"] input[type=range]`);
  await slider.scrollIntoViewIfNeeded();
  const box = await slider.boundingBox();
  await page.mouse.click(box.x + box.width * at, box.y + box.height / 2);
  await settled(page);
}

describe('an artist', { skip, timeout: 480_000 }, () => {
  after(endBrowser);

  test('clicks into sliders, and each click lands', () => within(RECIPE, async (page) => {
    for (const at of [0.1, 0.3, 0.5, 0.7, 0.9]) {
      await click(page, 'extent.0', at);
      assert.equal(await page.locator('.status .bad').count(), 0, `extent at ${at}`);
    }
    const [x] = (await text(page)).match(/extent = \[([\d.]+)/).slice(1).map(Number);
    assert.ok(x > 4 && Number.isInteger(x / 2), `the extent ${x} fits frequencies of 1.5 and 0.5`);
    for (let i = 0; i < 5; i += 1) await page.locator('body').press('Control+z');
    await settled(page);
    await select(page, 'fine');
    const before = await text(page);
    await click(page, 'nodes.fine.pups.octaves.octaves', 0.9);
    assert.equal(await page.locator('.status .bad').count(), 0);
    const octaves = Number((await text(page)).match(/octaves = (\d+)/)[1]);
    assert.ok(octaves > 1 && octaves < 9, `${octaves} octaves`);
    await page.keyboard.press('Control+z');
    await settled(page);
    assert.equal(await text(page), before, 'one step of undo');
  }));

  test('a slider of a pattern lands on a number of cells that repeats', () => {
    const bricks = (more) => `dapple = 1\n\n[nodes.wall.bricks]\n${more}\n\n[material]\nheight = "wall"\n`;
    return within(bricks('bond = "herringbone"\nfrequency = 8'), async (page) => {
      await select(page, 'wall');
      for (const at of [0.3, 0.45, 0.62, 0.7]) {
        await click(page, 'nodes.wall.bricks.frequency', at);
        await page.waitForFunction(() => document.querySelectorAll('.status .bad').length === 0);
        await settled(page);
        const frequency = Number((await text(page)).match(/frequency = ([\d.]+)/)[1]);
        assert.equal(frequency % 4, 0, `${frequency} at ${at}`);
      }
      assert.notEqual((await text(page)).match(/frequency = ([\d.]+)/)[1], '8');
    });
  });

  test('moves a shared parameter first in the list, and detaches an option from it', () => {
    const recipe = RECIPE.replace('extent = [4, 4]\n', 'extent = [4, 4]\n\n[parameters]\nrough = { value = 0.25, range = [0, 1], doc = "Wear." }\nsize = 1.5\n')
      .replace('frequency = 1.5', 'frequency = "$size"')
      .replace('height = "sum"', 'height = "sum"\nroughness = "$rough"\nmetallic = "$rough"');
    return within(recipe, async (page) => {
      const first = await page.locator('.parameters [data-path]').first().getAttribute('data-path');
      assert.equal(first, 'parameters.rough.value');
      await click(page, 'parameters.rough.value', 0.75);
      assert.match(await text(page), /rough = \{ value = 0\.7\d*, range = \[0, 1\]/);
      await click(page, 'parameters.size', 0.5);
      assert.doesNotMatch(await text(page), /size = 1\.5/);
      assert.match(await text(page), /frequency = "\$size"/);
      // An option shows the parameter, and gets a value of its own on request.
      await page.getByLabel('Detach metallic from rough').click();
      await settled(page);
      assert.match(await text(page), /metallic = 0\.7/);
      assert.match(await text(page), /roughness = "\$rough"/);
    });
  });

  test('deletes a node that is used, in one step of undo', () => within(RECIPE, async (page) => {
    const before = await text(page);
    await select(page, 'base');
    await page.locator('.svelte-flow__node[data-id=base]').press('Delete');
    await page.locator('.svelte-flow__node[data-id=base]').waitFor({ state: 'detached' });
    await settled(page);
    assert.match(await text(page), /add = \[0\.0, "cells"\]/);
    assert.equal(await page.locator('.status .bad').count(), 0);
    await page.locator('body').press('Control+z');
    await settled(page);
    assert.equal(await text(page), before);
  }));

  test('a text that names a missing node leaves the graph alive', () => within(RECIPE, async (page) => {
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+End');
    await page.keyboard.type('roughness = "none"');
    await page.locator('.status .bad').waitFor();
    assert.equal(await page.locator('.svelte-flow__node').count(), 5);
  }));

  test('holds B and compares with a sharp picture', () => within(RECIPE, async (page) => {
    const hash = () => page.evaluate(() => {
      const canvas = document.querySelector('canvas[data-map=height]');
      return canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.join();
    });
    const first = await hash();
    await page.locator('body').press('r');
    await settled(page);
    assert.notEqual(await hash(), first);
    await page.keyboard.down('b');
    await page.waitForTimeout(200);
    assert.equal(await hash(), first);
    assert.equal(await page.locator('figcaption').first().textContent(), 'height · before');
    await page.keyboard.up('b');
  }));

  test('saves under another name, reloads, and has the new file', () => within(RECIPE, async (page, studio) => {
    await page.locator('body').press('r');
    await settled(page);
    const saved = await text(page);
    await page.keyboard.press('Control+s');
    await page.locator('dialog input').fill('other.toml');
    await page.getByRole('button', { name: 'Save as' }).click();
    await page.locator('dialog').waitFor({ state: 'detached' });
    assert.equal(await page.locator('.rail .card', { hasText: 'other' }).count(), 1);
    await page.reload();
    await settled(page);
    await page.waitForFunction(() => document.querySelector('.what strong')?.textContent === 'other.toml');
    await settled(page);
    assert.equal(await text(page), saved);
    // The address of another studio opens its recipe.
    await page.evaluate(() => sessionStorage.setItem('dapple-open', JSON.stringify({ named: 'gone.toml', what: { file: 'other.toml' } })));
    await page.goto('about:blank');
    await page.goto(studio.url);
    await settled(page);
    assert.equal(await page.locator('.what strong').textContent(), 'mine.toml');
  }));

  test('edits without a server wait for it', async () => {
    const first = await serve(['mine.toml'], 'studio', folder());
    let second;
    try {
      const page = await open(first.url);
      await settled(page);
      first.child.removeAllListeners('exit');
      first.child.kill();
      await page.getByText('The studio has ended').waitFor();
      for (const seed of ['41', '42']) {
        await page.getByRole('spinbutton', { name: 'Seed', exact: true }).fill(seed);
        await page.keyboard.press('Tab');
      }
      await page.getByText('2 changes wait for it').waitFor();
      second = await serve(['--port', new URL(first.url).port, 'mine.toml'], 'studio', first.folder);
      await page.evaluate((url) => void (location.href = url), second.url);
      await settled(page);
      assert.match(await text(page), /^seed = 42$/m);
      assert.equal(await page.getByText('wait for it').count(), 0);
    } finally {
      first.end();
      second?.end();
    }
  });

  test('finds nodes by the words of other programs', () => within(RECIPE, async (page) => {
    for (const [word, kind] of [['voronoi', 'worley'], ['perlin', 'noise'], ['tile sampler', 'scatter'], ['gradient map', 'ramp'], ['map range', 'levels'], ['rotate', 'transform']]) {
      await page.locator('body').press('a');
      await page.locator('dialog[open]').waitFor();
      await page.keyboard.type(word);
      assert.equal(await page.locator('#choices li strong').first().textContent(), kind, word);
      await page.keyboard.press('Escape');
      await page.locator('dialog').waitFor({ state: 'detached' });
    }
    await page.locator('body').press('a');
    await page.locator('dialog[open]').waitFor();
    const missing = [];
    for (const word of WORDS) {
      await page.locator('dialog input').fill(word);
      if ((await page.locator('#choices li').count()) === 0) missing.push(word);
    }
    assert.deepEqual(missing, []);
    await page.locator('dialog input').fill('normal map');
    await page.getByText('No node of that name; the material has the map normal.').waitFor();
  }));

  test('exports any size, raw heights, and into a folder', () => within(RECIPE, async (page, studio) => {
    await page.keyboard.press('Control+e');
    const dialog = page.locator('dialog');
    await dialog.locator('select').nth(0).selectOption({ label: 'another size' });
    await dialog.getByLabel('Width in pixels').fill('96');
    await dialog.getByLabel('Height in pixels').fill('65');
    await dialog.locator('select').nth(2).selectOption('r16');
    await dialog.getByLabel('Folder beside the recipe').fill('maps');
    await dialog.getByRole('button', { name: 'Bake 96 × 65' }).click();
    await dialog.getByText('Written to maps/').waitFor();
    assert.equal(statSync(join(studio.folder, 'maps', 'recipe_height.r16')).size, 96 * 65 * 2);
    await dialog.getByRole('button', { name: /^Bake/ }).click();
    await dialog.getByRole('button', { name: 'Replace them' }).click();
    await dialog.getByText('Written to maps/').waitFor();
    await dialog.getByLabel('Folder beside the recipe').fill('../out');
    await dialog.getByRole('button', { name: /^Bake/ }).click();
    await dialog.getByText('is no name for a folder').waitFor();
  }));

  test('finds recipes by their tags', () => within(RECIPE, async (page) => {
    await page.getByRole('searchbox', { name: 'Search recipes' }).fill('volcano');
    assert.deepEqual((await page.locator('.rail .card .name').allTextContents()), ['lava']);
  }));

  test('files of another preset are not offered', () => within(RECIPE, async (page) => {
    await page.keyboard.press('Control+e');
    const dialog = page.locator('dialog');
    await dialog.locator('select').nth(0).selectOption({ index: 0 });
    await dialog.locator('select').nth(1).selectOption('unity');
    await dialog.getByRole('button', { name: /^Bake/ }).click();
    await dialog.locator('li').first().waitFor();
    await dialog.locator('select').nth(1).selectOption('unreal');
    await page.waitForTimeout(100);
    assert.equal(await dialog.locator('li').count(), 0);
  }));

  test('the time in the footer is that from the change to the picture', async () => {
    const studio = await serve(['mine.toml'], 'studio', folder());
    try {
      const page = await open('about:blank');
      await page.routeWebSocket(/\/ws/, (socket) => {
        const server = socket.connectToServer();
        server.onMessage((message) => setTimeout(() => socket.send(message), 400));
      });
      await page.goto(studio.url);
      await settled(page);
      const start = Date.now();
      await page.locator('body').press('r');
      await settled(page);
      await page.waitForFunction(() => / in \d+ ms$/.test(document.querySelector('.status span')?.textContent ?? ''));
      const told = Number((await page.locator('.status span').first().textContent()).match(/in (\d+) ms/)[1]);
      assert.ok(told >= 800 && told <= Date.now() - start, `${told} ms, for two delays of 400 ms`);
    } finally {
      studio.end();
    }
  });

  /** The picture of the lit view, reduced by `measure` to numbers, or null without WebGL. */
  async function lit(page, measure, wait = () => settled(page, 60_000)) {
    await page.locator('#tab-lit').click({ noWaitAfter: true });
    await page.locator('.lit canvas').waitFor({ timeout: 60_000 });
    await wait();
    if ((await page.locator('.lit .wrong').count()) > 0) return null;
    await page.waitForTimeout(1500);
    const picture = (await page.locator('.lit canvas').screenshot()).toString('base64');
    const { width, height, data } = await page.evaluate(async (data) => {
      const image = await createImageBitmap(new Blob([Uint8Array.from(atob(data), (c) => c.charCodeAt(0))]));
      const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
      context.drawImage(image, 0, 0);
      const { width, height, data: pixels } = context.getImageData(0, 0, image.width, image.height);
      return { width, height, data: Array.from(pixels, (byte) => String.fromCharCode(byte)).join('') };
    }, picture);
    return measure((x, y) => [0, 1, 2].map((channel) => data.charCodeAt((Math.floor(y) * width + Math.floor(x)) * 4 + channel)), width, height);
  }

  /** The color in the center. */
  const center = (at, width, height) => at(width / 2, height / 2);

  /** The largest of the green values in the middle of the sphere. */
  const brightest = (at, width, height) => {
    let most = 0;
    for (let y = -40; y <= 40; y += 1) for (let x = -40; x <= 40; x += 1) most = Math.max(most, at(width / 2 + (x * height) / 200, height / 2 + (y * height) / 200)[1]);
    return most;
  };
  const litRecipe = (more) => `dapple = 1\n[material]\nheight = 0.5\nalbedo = "#000000"\n${more}\n`;

  test('the lit view shows opacity, blended and cut off, and emission', async () => {
    const found = {};
    const glowing = 'emission = "#ff0000"\n';
    for (const [name, more] of Object.entries({
      solid: glowing,
      half: `${glowing}opacity = 0.5`,
      cut: `${glowing}opacity = 0.5\nopacity_cutoff = 0.75`,
    })) {
      await within(litRecipe(more), async (page) => {
        found[name] = await lit(page, center);
      });
      if (found[name] === null) return; // This browser has no WebGL, and the page says so.
    }
    const red = ([r, g]) => r - g;
    assert.ok(red(found.solid) > 150, JSON.stringify(found));
    assert.ok(red(found.cut) < 10, JSON.stringify(found));
    assert.ok(red(found.half) > 30 && red(found.half) < red(found.solid) - 30, JSON.stringify(found));
  });

  test('the lit view shows a clear coat, and the strength of reflections', async () => {
    const found = {};
    for (const [name, more] of Object.entries({ rough: 'roughness = 1', coat: 'roughness = 1\nclearcoat = 1', shiny: 'roughness = 0.3', none: 'roughness = 0.3\nspecular = 0' })) {
      await within(litRecipe(more), async (page) => {
        found[name] = await lit(page, brightest);
      });
      if (found[name] === null) return; // This browser has no WebGL, and the page says so.
    }
    assert.ok(found.coat > found.rough + 80, JSON.stringify(found));
    assert.ok(found.none < found.shiny - 40, JSON.stringify(found));
  });

  test('the lit view does not glow before its maps have arrived', async () => {
    const studio = await serve(['mine.toml'], 'studio', folder(litRecipe('emission = "#ff0000"\nemission_strength = 4')));
    try {
      const page = await open('about:blank');
      let emission = -1;
      await page.routeWebSocket(/\/ws/, (socket) => {
        const server = socket.connectToServer();
        server.onMessage((message) => {
          if (typeof message === 'string') {
            const reply = JSON.parse(message);
            if (reply.type === 'hello') emission = reply.maps.findIndex(({ name }) => name === 'emission');
          } else if (message.readUInt16LE(8) === emission) return; // Hold back the map.
          socket.send(message);
        });
      });
      await page.goto(studio.url);
      await settled(page);
      const dark = await lit(page, (at, width, height) => at(width / 2, height * 0.8), () => page.waitForTimeout(1000));
      if (dark === null) return; // This browser has no WebGL, and the page says so.
      assert.ok(Math.max(...dark) < 230, JSON.stringify(dark));
      assert.deepEqual(page.wrong, []);
    } finally {
      studio.end();
    }
  });

  test('an own model stays closed with relief', () => within('dapple = 1\n[material]\nheight = 1.0\nrelief = 0.1\nalbedo = "#400000"\n', async (page) => {
    // A cube: each face has its own corners in the texture, and no normals.
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => `v ${i & 1} ${(i >> 1) & 1} ${(i >> 2) & 1}`);
    const places = ['vt 0 0', 'vt 0.3 0', 'vt 0.3 0.3', 'vt 0 0.3'];
    const faces = ['1 3 4 2', '5 6 8 7', '1 2 6 5', '3 7 8 4', '1 5 7 3', '2 4 8 6'].map((face) => `f ${face.split(' ').map((v, i) => `${v}/${i + 1}`).join(' ')}`);
    await page.locator('#tab-lit').click();
    await page.locator('.lit canvas').waitFor({ timeout: 60_000 });
    await settled(page, 60_000);
    if ((await page.locator('.lit .wrong').count()) > 0) return; // This browser has no WebGL, and the page says so.
    await page.locator('.lit input[type=file]').setInputFiles({ name: 'cube.obj', mimeType: 'text/plain', buffer: Buffer.from([...corners, ...places, ...faces].join('\n')) });
    await page.getByText('cube.obj').waitFor();
    await page.waitForTimeout(1500);
    const picture = (await page.locator('.lit canvas').screenshot()).toString('base64');
    // In each row, the cube is one run of pixels that are redder than the background.
    const runs = await page.evaluate(async (data) => {
      const image = await createImageBitmap(new Blob([Uint8Array.from(atob(data), (c) => c.charCodeAt(0))]));
      const canvas = new OffscreenCanvas(image.width, image.height);
      const context = canvas.getContext('2d');
      context.drawImage(image, 0, 0);
      const { data: pixels } = context.getImageData(0, 0, image.width, image.height);
      return Array.from({ length: image.height }, (_, y) => {
        const is = (x) => pixels[(y * image.width + x) * 4] - pixels[(y * image.width + x) * 4 + 1] > 20;
        return Array.from({ length: Math.floor(image.width * 0.6) }, (_, x) => Math.floor(image.width * 0.2) + x).filter((x) => is(x) && !is(x - 1)).length;
      });
    }, picture);
    assert.ok(runs.filter((n) => n > 0).length > 100, 'the cube is seen');
    assert.deepEqual(runs.slice(0, Math.floor(runs.length * 0.85)).filter((n) => n > 1), []);
  }));
});
