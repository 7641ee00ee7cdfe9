// The tools in the bar: pin, open a file, save files, copy a link. Native elements, for keyboard and readers.

const LARGEST = 1_000_000;  // bytes of a file that is opened; Python checks it again
const WAIT = 400;  // ms until the address follows: browsers limit how often it may change

/** Send a file to Python as text in base64, or say why it is not sent. */
async function sendFile(file, send) {
  if (file.size > LARGEST) {
    send({ do: "refuse", fault: `${file.name}: larger than ${LARGEST} bytes` });
    return;
  }
  const bytes = new Uint8Array(await file.arrayBuffer());
  let text = "";
  for (let begin = 0; begin < bytes.length; begin += 32768) text += String.fromCharCode(...bytes.subarray(begin, begin + 32768));
  send({ do: "open", name: file.name, content: btoa(text) });
}

/** Have the browser save a content as a file. */
function saveFile(name, media, content) {
  const address = URL.createObjectURL(new Blob([content], { type: media }));
  const link = Object.assign(document.createElement("a"), { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

function button(text, title, pressed) {
  const made = Object.assign(document.createElement("button"), { type: "button", textContent: text, title });
  made.addEventListener("click", pressed);
  return made;
}

class Tools {
  constructor(root, model) {
    this.root = root; this.model = model; this.timer = null;
    const send = (message) => model.send_msg(message);
    root.className = "tools";
    this.pin = button("Pin", "Keep this run, to compare the next ones with it", () => send({ do: "pin" }));
    this.input = Object.assign(document.createElement("input"), { type: "file", accept: ".toml,.csv,.txt,.tsv,.dat", hidden: true });
    this.input.addEventListener("change", () => { if (this.input.files[0]) sendFile(this.input.files[0], send); this.input.value = ""; });
    const open = button("Open", "Open a scenario (TOML) or measured friction (CSV); files can also be dropped on the page", () => this.input.click());
    this.menu = document.createElement("details");
    this.summary = Object.assign(document.createElement("summary"), { textContent: "Save" });
    const list = document.createElement("ul");
    for (const { kind, label } of model.kinds) {
      const entry = document.createElement("li"), save = button(label, "", () => { send({ do: "save", kind }); this.close(true); });
      save.dataset.kind = kind;
      entry.append(save);
      list.append(entry);
    }
    this.menu.append(this.summary, list);
    this.menu.addEventListener("keydown", (event) => { if (event.key === "Escape") this.close(true); });
    this.link = button("Copy link", "Copy an address that shows this view", () => this.copy());
    this.link.hidden = !model.linked;
    this.said = Object.assign(document.createElement("span"), { className: "said" });
    this.said.setAttribute("role", "status");
    root.append(this.said, this.pin, open, this.input, this.menu, this.link);
    this.listeners = [
      ["pointerdown", (event) => { if (!event.composedPath().includes(this.menu)) this.close(false); }],
      ["dragover", (event) => { if ([...event.dataTransfer.types].includes("Files")) event.preventDefault(); }],
      ["drop", (event) => { if (event.dataTransfer.files[0]) { event.preventDefault(); sendFile(event.dataTransfer.files[0], send); } }],
    ];
    const place = model.linked ? document : root;
    for (const [kind, call] of this.listeners) place.addEventListener(kind, call);
    this.leave = () => { for (const [kind, call] of this.listeners) place.removeEventListener(kind, call); clearTimeout(this.timer); };
  }

  close(focus) {
    if (!this.menu.open) return;
    this.menu.open = false;
    if (focus) this.summary.focus();
  }

  say(text) {
    this.said.textContent = text;
    setTimeout(() => { this.said.textContent = ""; }, 4000);
  }

  async copy() {
    this.follow();
    if (this.model.query === "too-large") return this.say("too large for a link: save the scenario");
    try {
      await navigator.clipboard.writeText(window.location.href);
      this.say("copied");
    } catch {
      this.say("the address bar holds the link");
    }
  }

  /** Bring the address to what is shown, without a new entry in the history of the browser. */
  follow() {
    const { query, linked } = this.model;
    if (!linked || !query) return;
    const address = query === "too-large" ? window.location.pathname : `${window.location.pathname}?${query}`;
    if (address !== window.location.pathname + window.location.search) window.history.replaceState(null, "", address);
  }

  update() {
    const { pinned, ready, busy } = this.model;
    this.pin.disabled = !ready;
    this.pin.setAttribute("aria-pressed", String(pinned));
    this.pin.textContent = pinned ? "Unpin" : "Pin";
    this.summary.textContent = busy ? "Saving" : "Save";
    for (const one of this.menu.querySelectorAll("button")) one.disabled = !ready || busy;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.follow(), WAIT);
  }
}

/** Where Panel shows the tools. */
export function render({ model }) {
  const root = document.createElement("div");
  const tools = new Tools(root, model);
  model.on(["pinned", "ready", "busy", "query"], () => tools.update());
  model.on("msg:custom", ({ save, media, content }) => saveFile(save, media, content));
  model.on("remove", () => tools.leave());
  tools.update();
  return root;
}
