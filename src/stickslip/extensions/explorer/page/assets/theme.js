// The ground of the page, light or dark: every model of Bokeh that is tagged with roles takes their colours.

const STORED = "stickslip-ground";

/** The ground that the reader chose, or that the system prefers. */
function preferredGround() {
  try {
    const stored = localStorage.getItem(STORED);
    if (stored === "light" || stored === "dark") return stored;
  } catch { /* storage may be forbidden */ }
  return matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}

/** Have the page on one ground, and remember it. */
function chooseGround(ground) {
  document.documentElement.dataset.ground = ground;
  try { localStorage.setItem(STORED, ground); } catch { /* see above */ }
}

/** Give all models of a Bokeh document the colours of their roles, and sizes that follow the size of the page's type. */
function paintModels(bokeh, look, ground) {
  const scale = parseFloat(getComputedStyle(document.documentElement).fontSize) / 16;
  for (const model of bokeh.all_models ?? bokeh._all_models?.values() ?? []) {
    for (const tag of model.tags ?? []) {
      const changes = {};
      for (const [key, role] of Object.entries(tag?.paint ?? {})) changes[key] = look.colours[ground][role];
      for (const [key, size] of Object.entries(tag?.sizes ?? {})) {
        const scaled = Math.round(size * scale);
        changes[key] = key.endsWith("font_size") ? `${scaled}px` : scaled;
      }
      if (tag?.palette) changes.palette = look.palettes[ground][tag.palette];
      if (Object.keys(changes).length) model.setv(changes, { sync: false });
    }
  }
}
