// Headless Chromium with a software renderer, and a page that counts its errors.
import { chromium } from 'playwright-core';

const PLACES = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];

export async function launch() {
  const { existsSync } = await import('node:fs');
  const executablePath = process.env.CHROMIUM ?? PLACES.find((place) => existsSync(place));
  if (!executablePath) throw new Error('no Chromium: apt-get install chromium, or set CHROMIUM to one');
  return chromium.launch({
    executablePath,
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--force-color-profile=srgb'],
  });
}

// A page that keeps what went wrong in `errors`.
export async function newPage(browser, { width = 1280, height = 800, theme = 'dark', deviceScaleFactor = 1, touch = false } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, deviceScaleFactor, colorScheme: theme, hasTouch: touch, isMobile: touch, reducedMotion: 'reduce' });
  const page = await context.newPage();
  page.errors = [];
  page.on('console', (message) => message.type() === 'error' && page.errors.push(message.text()));
  page.on('pageerror', (error) => page.errors.push(String(error)));
  return page;
}

// Until a scene is open.
export async function ready(page, timeout = 30000) {
  await page.waitForFunction(() => window.gyre?.ready === true, null, { timeout });
}
