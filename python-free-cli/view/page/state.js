"use strict";
// What is shown: everything that a link restores, with its history.

/** Okabe and Ito's colours, which people with any colour vision tell apart. */
const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const mostMaterials = colours.length;

let state = {
  materials: [],
  selected: 0,
  theta: 45,
  phi: 0,
  quantity: "f",
  scale: "linear",
  form: "cartesian",
  compose: false,
  domain: 90,
  eye: { turn: -25, lift: 20 },
  light: { mode: "both", azimuth: -40, tilt: 60, colour: "#ffffff", sky: "#ffffff", fill: true },
  scene: { draw: false, index: 0, replaced: 0, samples: 64 },
};
const past = [];
const future = [];
let isInGesture = false;

const copyOf = (value) => JSON.parse(JSON.stringify(value));

/**
 * Changes what is shown. Changes of one gesture, such as a drag of a slider, are undone at once: it begins with
 * `isGesture` and lasts until endGesture().
 */
function change(apply, isGesture = false) {
  const before = copyOf(state);
  apply(state);
  if (JSON.stringify(before) === JSON.stringify(state)) return;
  if (!isInGesture) {
    past.push(before);
    if (past.length > 200) past.shift();
  }
  if (isInGesture && !isGesture) leaveGesture();
  isInGesture = isGesture;
  future.length = 0;
  showState();
}

/** What is drafted in a gesture is shown again by showState(), though it may not have changed since. */
function leaveGesture() {
  isInGesture = false;
  for (const key of ["spheres", "distances", "scene"]) delete shownParts[key];
}

function endGesture() {
  if (!isInGesture) return;
  isInGesture = false;
  showSpheres();
  showDistances();
  showScene();
}

function travel(from, to) {
  if (from.length === 0) return;
  to.push(copyOf(state));
  state = from.pop();
  if (isInGesture) leaveGesture();
  showState();
}

function stateLink() {
  return `#${encodeURIComponent(JSON.stringify(state))}`;
}

/** The state of a link, as far as it is one. \return whether it is */
function readLink(hash) {
  if (hash.length < 2) return false;
  try {
    const read = JSON.parse(decodeURIComponent(hash.slice(1)));
    if (!Array.isArray(read.materials) || read.materials.length === 0) return false;
    const isText = (text) => typeof text === "string";
    if (!read.materials.every(isText) || read.materials.length > mostMaterials) return false;
    state = { ...state, ...read, light: { ...state.light, ...read.light }, eye: { ...state.eye, ...read.eye },
      scene: sceneOf(read.scene) };
    state.selected = Math.min(Math.max(Number(state.selected) || 0, 0), state.materials.length - 1);
    return true;
  } catch {
    return false;
  }
}
