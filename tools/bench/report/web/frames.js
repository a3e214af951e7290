// Frames: a picture, depth or flow, and over it what was looked for, as vectors in the picture's own pixels.

/** Status of a feature, by its number: class and meaning. */
const kStatus = [
  ["matched", "matched"],
  ["missed", "looked for and not found"],
  ["rejected", "rejected as an outlier"],
  ["new", "new"],
];
const kEllipse = Math.sqrt(5.991); // of 95 % in two dimensions

/** @type {(feature: Feature) => SVGElement[]} */
function ellipseOf([, u, v, , , a, b, c]) {
  const [middle, half] = [(a + c) / 2, Math.hypot((a - c) / 2, b)];
  if (!(middle - half > 0)) return [];
  const angle = (Math.atan2(2 * b, a - c) / 2) * (180 / Math.PI);
  const [rx, ry] = [kEllipse * Math.sqrt(middle + half), kEllipse * Math.sqrt(middle - half)];
  return [
    makeSvg("ellipse", { class: "expected", rx, ry, transform: `translate(${u} ${v}) rotate(${angle.toFixed(1)})` }),
  ];
}

/** The middle of the first pixel is (0, 0). @type {(feature: Feature, ellipses: boolean) => SVGElement} */
function featureOf(feature, ellipses) {
  const [status, pu, pv, u, v] = feature;
  const [kind] = kStatus[status];
  if (kind === "new")
    return makeSvg("g", { class: kind }, makeSvg("rect", { x: u - 2, y: v - 2, width: 4, height: 4 }));
  const found = kind === "missed" ? [] : [makeSvg("circle", { cx: u, cy: v, r: 4 })];
  const d = kind === "missed" ? `M${pu - 3} ${pv - 3}l6 6m0 -6l-6 6` : `M${pu} ${pv}L${u} ${v}`;
  return makeSvg("g", { class: kind }, ...(ellipses ? ellipseOf(feature) : []), makeSvg("path", { d }), ...found);
}

/** @param {HTMLElement} holder @param {Frames} data @param {string[]} systems */
function showFrames(holder, data, systems) {
  const seen = [...systems.keys()].filter((s) => data.frames.some((frame) => frame.features[s]?.length > 0));
  /** @type {{index: number, layer: "picture" | "depth" | "flow", system: number}} */
  const state = { index: Math.floor(data.frames.length / 2), layer: "picture", system: seen[0] ?? 0 };
  const hidden = new Set();
  const picture = make("img", { width: String(data.width), height: String(data.height) });
  const overlay = makeSvg("svg", { viewBox: `-0.5 -0.5 ${data.width} ${data.height}`, "aria-hidden": "true" });
  const slider = make("input", { type: "range", min: "0", step: "1", "aria-label": "Frame" });
  const caption = make("figcaption");

  const legendText = () => {
    const [near, far] = data.depth_m?.map(exact) ?? [];
    if (state.layer === "depth") return `. Depth from ${near} m (yellow) to ${far} m (violet); black: nothing there`;
    if (state.layer === "picture") return "";
    const hues = "the hue is its direction (red to the right, then clockwise yellow, green, blue)";
    return `. Flow to the next frame: ${hues}, full colour is ${exact(data.flow_px)} px; black: unknown`;
  };
  const update = () => {
    const frame = data.frames[state.index];
    const features = frame.features[state.system] ?? [];
    const time = `${exact(frame.t)} s`;
    const numbers = kStatus.map(([kind], k) => `${features.filter((f) => f[0] === k).length} ${kind}`).join(", ");
    picture.src = `data:image/jpeg;base64,${frame[state.layer] ?? frame.picture}`;
    picture.alt = `Frame at ${time}, ${state.layer}, with features of ${systems[state.system] ?? ""}: ${numbers}`;
    caption.textContent = `${time}: ${numbers}${legendText()}`;
    slider.max = String(data.frames.length - 1);
    slider.hidden = data.frames.length < 2;
    slider.value = String(state.index);
    slider.setAttribute("aria-valuetext", time);
    const drawn = features.filter((feature) => !hidden.has(kStatus[feature[0]][0]));
    overlay.replaceChildren(...drawn.map((feature) => featureOf(feature, !hidden.has("ellipses"))));
  };

  /** Buttons of which one is pressed; of a single choice none.
   *  @type {(name: string, member: "layer" | "system", options: [any, string][]) => HTMLElement[]} */
  const choice = (name, member, options) => {
    const buttons = options.map(([value, text]) => {
      const press = () => {
        Object.assign(state, { [member]: value });
        for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
        update();
      };
      const button = makeButton(press, { "aria-pressed": String(value === state[member]) }, text);
      return button;
    });
    return buttons.length > 1 ? [make("div", { class: "legend", role: "group", "aria-label": name }, ...buttons)] : [];
  };
  const toggles = [...kStatus, ["ellipses", "95 % ellipses"]].map(([kind, meaning]) => {
    const press = () => {
      if (!hidden.delete(kind)) hidden.add(kind);
      button.setAttribute("aria-pressed", String(!hidden.has(kind)));
      update();
    };
    const swatch = make("span", { class: `swatch mark ${kind}`, "aria-hidden": "true" });
    const button = makeButton(press, { "aria-pressed": "true" }, swatch, meaning);
    return button;
  });
  slider.addEventListener("input", () => {
    state.index = Number(slider.value);
    update();
  });

  const layers = [
    ["picture", "picture"],
    ["depth", "true depth"],
    ["flow", "true flow"],
  ];
  const there = layers.filter(([layer]) => data.frames.some((frame) => layer in frame));
  holder.replaceChildren(
    make(
      "div",
      { class: "controls" },
      ...choice(
        "System",
        "system",
        seen.map((s) => [s, systems[s]]),
      ),
      ...choice("Picture", "layer", /** @type {[string, string][]} */ (there)),
      make("div", { class: "legend", role: "group", "aria-label": "Drawn over the picture" }, ...toggles),
    ),
    make("figure", { class: "viewer" }, make("div", { class: "stack" }, picture, overlay), slider, caption),
  );
  update();
}
