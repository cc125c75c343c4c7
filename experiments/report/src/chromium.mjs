// Headless Chromium through chromedriver's HTTP protocol; needs node 18 and two apt
// packages.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as pause } from 'node:timers/promises';

const free_port = () =>
  new Promise((resolve) => {
    const server = createServer().listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });

const element_key = 'element-6066-11e4-a52e-4f735466cecf';

export class Browser {
  static async start({
    driver = process.env.CHROMEDRIVER ?? 'chromedriver',
    binary = process.env.CHROMIUM ?? '/usr/bin/chromium',
    dark = false,
  } = {}) {
    const browser = new Browser();
    browser.profile = mkdtempSync(join(tmpdir(), 'tress-report-'));
    const port = await free_port();
    browser.process = spawn(driver, [`--port=${port}`], { stdio: 'ignore' });
    browser.root = `http://127.0.0.1:${port}`;
    await browser.wait_for_driver();
    const { sessionId } = await browser.call('POST', '/session', {
      capabilities: {
        alwaysMatch: {
          browserName: 'chrome',
          'goog:loggingPrefs': { browser: 'ALL', performance: 'ALL' },
          'goog:chromeOptions': {
            binary,
            args: [
              '--headless=new',
              // Root has none of the namespaces that the sandbox is made of.
              ...(process.getuid?.() === 0 ? ['--no-sandbox'] : []),
              '--disable-gpu',
              '--enable-unsafe-swiftshader',
              '--disable-dev-shm-usage',
              '--disable-background-networking',
              '--disable-component-update',
              '--disable-sync',
              '--no-first-run',
              '--disable-quic',
              '--force-device-scale-factor=1',
              '--hide-scrollbars',
              `--blink-settings=preferredColorScheme=${dark ? 0 : 1}`,
              `--user-data-dir=${browser.profile}`,
            ],
          },
        },
      },
    });
    browser.session = `/session/${sessionId}`;
    // Scripts on a busy machine may take longer than the 30 s that are usual.
    await browser.command('/timeouts', { script: 120000 });
    // Chromium's own start page must not be counted among the page's requests.
    await browser.command('/url', { url: 'about:blank' });
    await browser.requests();
    return browser;
  }

  async wait_for_driver() {
    for (let attempt = 0; attempt < 500; ++attempt) {
      const ready = await fetch(`${this.root}/status`).then(
        (r) => r.json(),
        () => undefined,
      );
      if (ready?.value?.ready) return;
      await pause(20);
    }
    throw new Error('chromedriver did not start');
  }

  async call(method, path, body) {
    const response = await fetch(this.root + path, {
      method,
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    });
    const { value } = await response.json();
    if (!response.ok) throw new Error(`${path}: ${value.error}: ${value.message}`);
    return value;
  }

  command(path, body) {
    return this.call('POST', this.session + path, body);
  }

  // Runs a function body in the page.
  run(script, ...args) {
    return this.command('/execute/sync', { script, args });
  }

  devtools(cmd, params) {
    return this.command('/goog/cdp/execute', { cmd, params });
  }

  // Loads `url` at a viewport of exactly `width` CSS pixels, `scale` pixels of the picture
  // each, and waits until all is drawn.
  async open(url, width = 1400, height = 1000, scale = 1) {
    await this.devtools('Emulation.setDeviceMetricsOverride', {
      width,
      height,
      deviceScaleFactor: scale,
      mobile: false,
    });
    // A new document, also when only the address's last part differs.
    await this.command('/url', { url: 'about:blank' });
    await this.command('/url', { url });
    for (let attempt = 0; attempt < 1000; ++attempt) {
      if (await this.run("return document.documentElement.dataset.ready === 'yes'"))
        return;
      await pause(20);
    }
    throw new Error(`${url}: the page was not ready after 20 s`);
  }

  // A trusted mouse click on the first element that matches the selector.
  async click(selector) {
    const found = await this.command('/element', {
      using: 'css selector',
      value: selector,
    });
    await this.command(`/element/${found[element_key]}/click`, {});
  }

  // A trusted click at viewport coordinates, for drawn marks.
  async click_at(x, y) {
    await this.command('/actions', {
      actions: [
        {
          type: 'pointer',
          id: 'mouse',
          actions: [
            { type: 'pointerMove', x: Math.round(x), y: Math.round(y) },
            { type: 'pointerDown', button: 0 },
            { type: 'pointerUp', button: 0 },
          ],
        },
      ],
    });
  }

  // The mouse pressed at one place of the viewport and let go at another.
  async drag([x, y], [to_x, to_y]) {
    const move = (px, py) => ({
      type: 'pointerMove',
      x: Math.round(px),
      y: Math.round(py),
      duration: 50,
    });
    await this.command('/actions', {
      actions: [
        {
          type: 'pointer',
          id: 'mouse',
          actions: [
            move(x, y),
            { type: 'pointerDown', button: 0 },
            move(to_x, to_y),
            { type: 'pointerUp', button: 0 },
          ],
        },
      ],
    });
  }

  // A key pressed and released; special keys by their WebDriver code points.
  async press(key) {
    await this.command('/actions', {
      actions: [
        {
          type: 'key',
          id: 'keyboard',
          actions: [
            { type: 'keyDown', value: key },
            { type: 'keyUp', value: key },
          ],
        },
      ],
    });
  }

  async log(kind) {
    return this.command('/se/log', { type: kind });
  }

  async requests() {
    const entries = await this.log('performance');
    return entries
      .map((entry) => JSON.parse(entry.message).message)
      .filter(({ method }) => method === 'Network.requestWillBeSent')
      .map(({ params }) => params.request.url);
  }

  // Full-page screenshot as PNG bytes.
  async screenshot() {
    const { cssContentSize } = await this.devtools('Page.getLayoutMetrics', {});
    const { data } = await this.devtools('Page.captureScreenshot', {
      captureBeyondViewport: true,
      clip: {
        x: 0,
        y: 0,
        width: cssContentSize.width,
        height: cssContentSize.height,
        scale: 1,
      },
    });
    return Buffer.from(data, 'base64');
  }

  async stop() {
    await this.call('DELETE', this.session).catch(() => undefined);
    this.process.kill();
    rmSync(this.profile, {
      recursive: true,
      force: true,
      maxRetries: 5,
      retryDelay: 200,
    });
  }
}
