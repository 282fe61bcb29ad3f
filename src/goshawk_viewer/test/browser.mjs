// Headless Chromium on a page, by playwright-core, for the tests that look at pages.
import {createRequire} from 'node:module';
import {existsSync} from 'node:fs';

// [ms] for what hangs: a busy machine, which draws without a graphics card, may take long.
export const kPatience = 120000;

/** @return a browser that draws WebGL without a graphics card */
export async function launch(extra = []) {
  const require = createRequire(process.env.GOSHAWK_NODE_MODULES + '/');
  const {chromium} = require('playwright-core');
  return chromium.launch({
    executablePath: process.env.GOSHAWK_CHROMIUM || '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
           '--ignore-gpu-blocklist', ...extra],
  });
}

/** Opens a page and gathers whatever it complains about. */
export async function open(browser, url, size = {width: 1440, height: 900}) {
  const context = await browser.newContext({viewport: size, deviceScaleFactor: 1});
  const page = await context.newPage();
  page.setDefaultTimeout(kPatience);
  const complaints = [];
  page.on('console', message => {
    if (message.type() === 'error') complaints.push(message.text());
  });
  page.on('pageerror', error => complaints.push(String(error)));
  page.on('requestfailed', request => complaints.push('cannot load ' + request.url()));
  await page.goto(url, {timeout: kPatience});
  await page.waitForFunction(() => window.goshawk !== undefined, null, {timeout: kPatience});
  return {page, complaints};
}

let failures = 0;
export function check(condition, sentence) {
  console.log((condition ? 'ok   ' : 'FAIL ') + sentence);
  if (!condition) failures += 1;
}
export function end() { process.exit(failures === 0 ? 0 : 1); }
export function fileThere(path) { return existsSync(path); }
