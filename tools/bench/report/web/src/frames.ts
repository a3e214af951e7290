// The frames: a picture, depth or flow, and over it what was looked for, as vectors in the picture's own pixels.
import type { Feature, Frames } from "./data";
import { exact, make, makeSvg } from "./dom";

const kStatus = ["matched", "missed", "rejected", "new"] as const;
const kMeaning = ["matched", "looked for and not found", "rejected as an outlier", "new"];
const kEllipse = Math.sqrt(5.991); // of 95 % in two dimensions

type Layer = "picture" | "depth" | "flow";

function ellipse(feature: Feature): SVGElement | undefined {
  const [, u, v, , , a, b, c] = feature;
  const middle = (a + c) / 2;
  const half = Math.hypot((a - c) / 2, b);
  if (!(middle - half > 0)) return undefined;
  const angle = (Math.atan2(2 * b, a - c) / 2) * (180 / Math.PI);
  return makeSvg("ellipse", {
    class: "expected",
    rx: kEllipse * Math.sqrt(middle + half),
    ry: kEllipse * Math.sqrt(middle - half),
    transform: `translate(${u} ${v}) rotate(${angle.toFixed(1)})`,
  });
}

// In the middle of the first pixel is (0, 0).
function draw(features: Feature[], overlay: SVGElement, hidden: Set<string>): void {
  for (const feature of features) {
    const [status, pu, pv, u, v] = feature;
    const kind = kStatus[status] ?? "missed";
    if (hidden.has(kind)) continue;
    const group = makeSvg("g", { class: kind });
    const around = kind === "new" || hidden.has("ellipses") ? undefined : ellipse(feature);
    if (around) group.append(around);
    if (kind === "matched" || kind === "rejected") {
      group.append(makeSvg("path", { d: `M${pu} ${pv}L${u} ${v}` }), makeSvg("circle", { cx: u, cy: v, r: 4 }));
    } else if (kind === "missed") {
      group.append(makeSvg("path", { d: `M${pu - 3} ${pv - 3}l6 6m0 -6l-6 6` }));
    } else {
      group.append(makeSvg("rect", { x: u - 2, y: v - 2, width: 4, height: 4 }));
    }
    overlay.append(group);
  }
}

// Returns what shows other frames in their place, as they come while the program runs.
export function showFrames(holder: HTMLElement, data: Frames, systems: string[]): (next: Frames) => void {
  let index = Math.floor(data.frames.length / 2);
  let layer: Layer = "picture";
  const seen = systems.map((_, s) => s).filter((s) => data.frames.some((frame) => (frame.features[s]?.length ?? 0) > 0));
  let system = seen[0] ?? 0;
  const hidden = new Set<string>();

  const picture = make("img", { width: String(data.width), height: String(data.height) });
  const overlay = makeSvg("svg", { viewBox: `-0.5 -0.5 ${data.width} ${data.height}`, "aria-hidden": "true" });
  const slider = make("input", { type: "range", min: "0", step: "1", "aria-label": "Frame" });
  const caption = make("figcaption");

  function update(): void {
    const frame = data.frames[index];
    if (!frame) return;
    const features = frame.features[system] ?? [];
    const time = `${exact(frame.t)} s`;
    const numbers = kStatus.map((kind, k) => `${features.filter((f) => f[0] === k).length} ${kind}`).join(", ");
    picture.src = `data:image/jpeg;base64,${frame[layer] ?? frame.picture}`;
    picture.alt = `Frame at ${time}, ${layer}, with features of ${systems[system] ?? ""}: ${numbers}`;
    caption.textContent = `${time}: ${numbers}${scaleText()}`;
    slider.max = String(data.frames.length - 1);
    slider.hidden = data.frames.length < 2;
    slider.value = String(index);
    slider.setAttribute("aria-valuetext", time);
    overlay.replaceChildren();
    draw(features, overlay, hidden);
  }
  function scaleText(): string {
    if (layer === "depth" && data.depth_m) return `. Depth from ${exact(data.depth_m[0])} m (yellow) to ${exact(data.depth_m[1])} m (violet); black: nothing there`;
    if (layer === "flow" && data.flow_px) return `. Flow to the next frame: the hue is its direction (red to the right, then clockwise yellow, green, blue), full colour is ${exact(data.flow_px)} px; black: unknown`;
    return "";
  }

  const choose = <Value>(name: string, options: [Value, string][], now: () => Value, set: (value: Value) => void) => {
    const group = make("div", { class: "legend", role: "group", "aria-label": name });
    const buttons = options.map(([value, text]) => {
      const button = make("button", { type: "button" }, text);
      button.addEventListener("click", () => {
        set(value);
        press();
        update();
      });
      group.append(button);
      return { value, button };
    });
    const press = () => buttons.forEach(({ value, button }) => button.setAttribute("aria-pressed", String(value === now())));
    press();
    return group;
  };
  const toggles = make("div", { class: "legend", role: "group", "aria-label": "Drawn over the picture" });
  for (const [kind, meaning] of [...kStatus.map((status, k) => [status, kMeaning[k]] as const), ["ellipses", "95 % ellipses"] as const]) {
    const swatch = make("span", { class: `swatch mark ${kind}`, "aria-hidden": "true" });
    const button = make("button", { type: "button", "aria-pressed": "true" }, swatch, meaning ?? kind);
    button.addEventListener("click", () => {
      if (!hidden.delete(kind)) hidden.add(kind);
      button.setAttribute("aria-pressed", String(!hidden.has(kind)));
      update();
    });
    toggles.append(button);
  }
  slider.addEventListener("input", () => {
    index = Number(slider.value);
    update();
  });

  const layers: [Layer, string][] = [["picture", "picture"]];
  if (data.frames.some((frame) => frame.depth)) layers.push(["depth", "true depth"]);
  if (data.frames.some((frame) => frame.flow)) layers.push(["flow", "true flow"]);
  const controls = make("div", { class: "controls" });
  if (seen.length > 1) controls.append(choose("System", seen.map((s) => [s, systems[s] ?? ""]), () => system, (s) => (system = s)));
  if (layers.length > 1) controls.append(choose("Picture", layers, () => layer, (l) => (layer = l)));
  controls.append(toggles);
  holder.replaceChildren(controls, make("figure", { class: "viewer" }, make("div", { class: "stack" }, picture, overlay), slider, caption));
  update();
  return (next) => {
    data = next;
    index = Math.min(index, next.frames.length - 1);
    update();
  };
}
