// Browsers start no worker for a page from a disk: there a hidden frame does what the search's worker would do.
if (location.protocol === "file:")
  window.Worker = class {
    constructor(url) {
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      this.frame.srcdoc = "<!doctype html>";
      this.ready = new Promise((done) => (this.frame.onload = done)).then(() => this.load(String(url)));
      document.documentElement.append(this.frame);
    }

    load(url) {
      const inner = this.frame.contentWindow;
      inner.postMessage = (sent) => {
        const data = structuredClone(sent); // as a worker does, which shares nothing
        setTimeout(() => this.onmessage?.(new MessageEvent("message", { data })));
      };
      const script = inner.document.createElement("script");
      script.src = new URL(url, location);
      const loaded = new Promise((done) => (script.onload = done));
      inner.document.head.append(script);
      return loaded;
    }

    postMessage(sent) {
      const data = structuredClone(sent);
      this.ready.then(() => this.frame.contentWindow?.dispatchEvent(new MessageEvent("message", { data })));
    }

    terminate() {
      this.frame.remove();
    }
  };
