// A browser without a screen, which notes what a page says, asks for and runs.
import puppeteer from "../../page/node_modules/puppeteer-core/lib/esm/puppeteer/puppeteer-core.js";

export class Browser {
  static async launch() {
    const browser = await puppeteer.launch({ executablePath: process.env.HWSIM_CHROMIUM, args: ["--no-sandbox", "--disable-gpu"] });
    return new Browser(browser);
  }

  constructor(browser) {
    this.browser = browser;
    this.heard = []; // console, errors, requests, dialogs
  }

  // The page with its scripts run to the end, or without scripts.
  async open(file, { scripts = true } = {}) {
    const page = await this.browser.newPage();
    await page.setViewport({ width: 1200, height: 900 });
    await page.setJavaScriptEnabled(scripts);
    page.on("console", (message) => this.heard.push(`console: ${message.text()}`));
    page.on("pageerror", (error) => this.heard.push(`error: ${error.message}`));
    page.on("dialog", (dialog) => {
      this.heard.push(`dialog: ${dialog.message()}`);
      dialog.dismiss();
    });
    page.on("request", (request) => {
      const url = request.url();
      if (!/^(data|blob|about):/.test(url) && !url.startsWith(`file://${file}`)) this.heard.push(`request: ${url.slice(0, 200)}`);
    });
    await page.goto(`file://${file}`);
    if (scripts) await page.waitForFunction("document.documentElement.dataset.drawn !== undefined", { timeout: 60000 });
    return page;
  }

  close() {
    return this.browser.close();
  }
}
