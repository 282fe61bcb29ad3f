// Headless Chromium on a page, by playwright-core, for the tests that look at pages.
import {createRequire} from 'node:module';

// [ms] for what hangs: a busy machine, which draws without a graphics card, may take long.
const kPatience = 300000;

/** @return a browser that draws WebGL without a graphics card */
export async function launch() {
  const require = createRequire(process.env.GOSHAWK_NODE_MODULES + '/');
  const {chromium} = require('playwright-core');
  return chromium.launch({
    executablePath: process.env.GOSHAWK_CHROMIUM || '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
           '--ignore-gpu-blocklist'],
  });
}

// Without a graphics card every frame costs the processor a tenth of a second and more, which the
// stages that a page looks at need as well: two frames a second are enough for a test.
function fewFrames() {
  window.requestAnimationFrame = callback => setTimeout(() => callback(performance.now()), 500);
  window.cancelAnimationFrame = clearTimeout;
}

function noWebGL() {
  const getContext = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function(kind, ...rest) {
    return /webgl/.test(kind) ? null : getContext.call(this, kind, ...rest);
  };
}

/** Opens a page and gathers whatever it complains about: its own errors begin with "page: ". */
export async function open(browser, url, options = {}) {
  const {size = {width: 800, height: 560}, webgl = true, onRequest = () => {},
         onResponse = () => {}} = options;
  const context = await browser.newContext({viewport: size, deviceScaleFactor: 1});
  await context.addInitScript(fewFrames);
  if (!webgl) await context.addInitScript(noWebGL);
  const page = await context.newPage();
  page.setDefaultTimeout(kPatience);
  const complaints = [];
  page.on('console', message => {
    if (message.type() === 'error') complaints.push(message.text());
  });
  page.on('pageerror', error => complaints.push('page: ' + error));
  page.on('requestfailed', request => complaints.push('cannot load ' + request.url()));
  page.on('request', onRequest);
  page.on('response', onResponse);
  await page.goto(url, {timeout: kPatience, waitUntil: 'commit'});
  return {page, complaints};
}

/** Waits for a condition in the page. @return whether it came true */
export function until(page, condition, argument = null) {
  return page.waitForFunction(condition, argument, {timeout: kPatience, polling: 100})
      .then(() => true, () => false);
}

let failures = 0;
export function check(condition, sentence) {
  console.log(`${condition ? 'ok   ' : 'FAIL '}${performance.now() / 1000 | 0} s: ${sentence}`);
  if (!condition) failures += 1;
}
export function end() { process.exit(failures === 0 ? 0 : 1); }
