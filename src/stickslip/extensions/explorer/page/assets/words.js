// The words above the panels. The elements stay and only their texts change, so that readers of the screen are told what is new.

const WORDS = `
  <p class="sentence" role="status" aria-live="polite"><strong class="regime"></strong><span></span></p>
  <div class="below">
    <p class="fault" role="alert"></p>
    <p class="progress" aria-live="polite"></p>
    <button class="stop" type="button" hidden>Stop</button>
    <p class="notes"></p>
  </div>`;

/** Set a text, and as a tooltip too, because it may be cut off. */
function put(element, text) {
  if (element.textContent !== text) { element.textContent = text; element.title = text; }
}

/** Where Panel shows the words: `model.texts` comes from Python, and "stop" goes back. */
export function render({ model }) {
  const root = document.createElement("div");
  root.className = "words";
  root.innerHTML = WORDS;
  const find = (name) => root.querySelector(name);
  find(".stop").addEventListener("click", () => model.send_msg("stop"));
  const update = () => {
    const { sentence = "", regime = "", fault = "", progress = "", notes = [] } = model.texts;
    const first = regime && sentence.toLowerCase().startsWith(regime) ? sentence.slice(0, regime.length) : "";
    find(".regime").className = `regime ${first.toLowerCase()}`;
    put(find(".regime"), first);
    put(find(".sentence span"), sentence.slice(first.length));
    put(find(".fault"), fault);
    put(find(".progress"), progress);
    put(find(".notes"), notes.join(" · "));
    find(".stop").hidden = !progress;
  };
  model.on("texts", update);
  update();
  return root;
}
