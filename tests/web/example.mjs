// example.mjs FOLDER HNBRDF MODEL MATERIAL [PICTURE.png]: opens the page that examples/web.sh prepared in FOLDER and
// compares pixels of what the browser shows with values of the C library. examples.mjs says what FOLDER's page shows.
import { writeFileSync } from 'node:fs';
import { basename } from 'node:path';
import { serve } from '../../examples/serve.mjs';
import { withPage } from './browser.mjs';
import { examples } from './examples.mjs';
import { expect } from './expected.mjs';

const [folder, hnbrdf, model, material, picture] = process.argv.slice(2);
const size = 256;

// The pixels of a PNG file, decoded by the page: rows of red, green, blue, alpha.
async function decode(page, png) {
  const text = await page.evaluate(`(async () => {
    const image = new Image();
    image.src = 'data:image/png;base64,${png.toString('base64')}';
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    let text = '';
    for (const byte of context.getImageData(0, 0, image.width, image.height).data) text += String.fromCharCode(byte);
    return btoa(text);
  })()`);
  return Buffer.from(text, 'base64');
}

// Pixels all over a sphere of `size` pixels, on spirals from its middle to 85 % of its radius.
function pixelsOf() {
  const pixels = [];
  for (let i = 0; i < 24; i++) {
    const radius = 0.85 * Math.sqrt((i + 0.5) / 24) * size / 2 * 0.96;
    const angle = i * 2.399963;
    pixels.push([Math.floor(size / 2 + radius * Math.cos(angle)), Math.floor(size / 2 + radius * Math.sin(angle))]);
  }
  return pixels;
}

const { spheres, address = '' } = examples[basename(folder)];
const width = size * spheres.length;
const server = await serve(folder);
let failed = 0;
try {
  await withPage(async (page) => {
    const start = Date.now();
    await page.open(server.url + address);
    await page.evaluate(`import('/main.js').then(() => null)`); // waits for its end, and has its error
    await page.evaluate('new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(null))))');
    const png = await page.screenshot();
    console.log(`drawn in ${((Date.now() - start) / 1000).toFixed(2)} s`);
    if (picture) writeFileSync(picture, png);
    const shown = await decode(page, png);
    for (const message of page.messages) console.log(message);
    for (const [place, { name, ...shape }] of spheres.entries()) {
      let widest = 0;
      for (const { pixel: [x, y], low, high } of expect(hnbrdf, model, material, size, pixelsOf(), shape)) {
        const at = 4 * (y * width + x + size * place);
        const found = [...shown.subarray(at, at + 3)];
        widest = Math.max(widest, ...high.map((h, c) => h - low[c]));
        if (found.some((v, c) => v < low[c] || v > high[c])) {
          const text = (values) => values.map((v) => v.toFixed(2)).join(' ');
          console.log(`${name}: pixel ${x}, ${y} is ${found}, expected ${text(low)} to ${text(high)}`);
          failed = 1;
        }
      }
      console.log(`${name}: 24 pixels, each channel within an interval at most ${widest.toFixed(2)} of 255 wide`);
    }
  }, { size: [width, size] });
} finally {
  server.close();
}
process.exit(failed);
