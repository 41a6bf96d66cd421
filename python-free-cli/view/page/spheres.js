"use strict";
// Spheres under lights that can be moved and coloured, beside the grey reference.

const sphereSize = 192;
const draftSize = 96;
const greyReference = () => `lambert:scale=${catalogue.reference.albedo}`;

/** "#rrggbb" as linear sRGB. */
function linearColour(text) {
  return [1, 3, 5].map((at) => {
    const value = parseInt(text.slice(at, at + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
}

const radians = (degrees) => (degrees * Math.PI) / 180;

/** Where the light is; azimuth 0 is above, 90 to the right; tilt 0 is at the viewer, 90 beside the sphere. */
function keyDirection() {
  const { azimuth, tilt } = state.light;
  const aside = Math.sin(radians(tilt));
  return [Math.sin(radians(azimuth)) * aside, Math.cos(radians(azimuth)) * aside, Math.cos(radians(tilt))];
}

/** The light with which the highlight of a mirror appears at a place of the sphere, -1 to 1 across it. */
function lightFor(x, y) {
  const tilt = 2 * Math.asin(Math.min(Math.hypot(x, y), 0.9)) * (180 / Math.PI);
  return { azimuth: Math.round(Math.atan2(x, y) * (180 / Math.PI)), tilt: Math.round(tilt) };
}

function lightsAsked() {
  const { mode, colour, sky, fill } = state.light;
  const white = [1, 1, 1];
  const lights = {};
  if (mode !== "daylight") {
    const [first, ...others] = catalogue.points;
    lights.points = [{ direction: keyDirection(), irradiance: first.irradiance, colour: linearColour(colour) }];
    const unit = (direction) => direction.map((one) => one / Math.hypot(...direction));
    if (fill) for (const one of others) lights.points.push({ ...one, direction: unit(one.direction), colour: white });
  }
  if (mode !== "point") lights.sky = { radiance: 1, colour: linearColour(sky) };
  return lights;
}

/** Pixels of an answer. */
function drawSphere(canvas, answer) {
  const bytes = atob(answer.rgb);
  const image = new ImageData(answer.size, answer.size);
  for (let pixel = 0, from = 0; from < bytes.length; pixel += 4, from += 3) {
    image.data[pixel] = bytes.charCodeAt(from);
    image.data[pixel + 1] = bytes.charCodeAt(from + 1);
    image.data[pixel + 2] = bytes.charCodeAt(from + 2);
    image.data[pixel + 3] = 255;
  }
  canvas.width = answer.size;
  canvas.height = answer.size;
  canvas.getContext("2d").putImageData(image, 0, 0);
}

function moveLight(event) {
  const box = event.currentTarget.getBoundingClientRect();
  const x = ((event.clientX - box.left) / box.width) * 2 - 1;
  const y = 1 - ((event.clientY - box.top) / box.height) * 2;
  change((now) => Object.assign(now.light, lightFor(x, y)), true);
}

/** A figure per material, after that of the grey reference. */
function sphereFigures() {
  const row = document.getElementById("sphere-row");
  const wanted = state.materials.length + 1;
  while (row.children.length > wanted) row.lastChild.remove();
  while (row.children.length < wanted) {
    const figure = document.createElement("figure");
    const canvas = document.createElement("canvas");
    canvas.setAttribute("role", "img");
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      canvas.setPointerCapture(event.pointerId);
      moveLight(event);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 1) moveLight(event);
    });
    canvas.addEventListener("pointerup", endGesture);
    canvas.addEventListener("pointercancel", endGesture);
    figure.append(canvas, document.createElement("figcaption"));
    row.append(figure);
  }
  return [...row.children];
}

const gpu = Gpu.make();
/**
 * How the graphics processor draws each sphere: its `text`, the `shader` and the `sky` of the newest answers, whether the
 * material of `judgedText` needs a texture, and for which texts a texture (`textureText`) and a sky (`skyText`) were asked for. Where a slider changes the material, what was known
 * before stays until the answers come; another material begins anew.
 */
const gpuParts = [];
let exposure = null;
let isDrawAsked = false;

const spherePixels = () => sphereSize * Math.min(2, Math.ceil(window.devicePixelRatio || 1));
const sphereTexts = () => [greyReference(), ...state.materials];

/** Draws what moves, once per frame. */
function drawMoving() {
  isDrawAsked = false;
  if (!isInGesture || gpu === null || exposure === null) return;
  const lights = lightsAsked();
  sphereFigures().forEach((figure, i) => {
    if (!isMovedByGpu(i) || !gpu.draw(gpuParts[i].shader, gpuParts[i].sky, lights, exposure, spherePixels())) return;
    const canvas = figure.children[0];
    canvas.width = gpu.canvas.width;
    canvas.height = gpu.canvas.height;
    canvas.getContext("2d").drawImage(gpu.canvas, 0, 0);
  });
}

function askDraw() {
  if (!isInGesture || isDrawAsked) return;
  isDrawAsked = true;
  requestAnimationFrame(drawMoving);
}

/** Whether the sky of a shader's material is known at once. */
const hasQuickSky = (shader) => shader.numbers === undefined && shader.is_isotropic;

/** Whether all is there to draw a sphere while it moves. */
function isMovedByGpu(i) {
  const part = gpuParts[i];
  if (gpu === null || part?.shader === undefined || !gpu.takes(part.shader)) return false;
  const lights = lightsAsked();
  if (lights.sky === undefined) return true;
  if (part.sky === undefined) return false;
  // Daylight alone would not move with the sky of before.
  return lights.points !== undefined || hasQuickSky(part.shader) || part.skyText === part.text;
}

/** Asks for what the graphics processor draws a sphere by. */
function learnSphere(i, text) {
  if (gpu === null) return;
  if (gpuParts[i]?.text !== text) {
    forget(`texture ${i}`);
    // A texture is of one material, however little a slider moves.
    if (!isInGesture || gpuParts[i] === undefined || gpuParts[i].shader?.numbers !== undefined) {
      forget(`sky ${i}`);
      gpuParts[i] = {};
    }
    const part = gpuParts[i];
    part.text = text;
    delete part.textureText;
    ask(`shader ${i}`, "shader", { material: text }, (answer, error) => {
      if (gpuParts[i] !== part) return;
      part.judgedText = text;
      part.needsTexture = error !== null || answer.reason !== undefined;
      if (part.needsTexture) delete part.shader;
      else part.shader = answer;
      learnTexture(i);
      learnSky(i);
      drawSoon(i);
    });
  }
  learnTexture(i);
  learnSky(i);
}

/** Draws a sphere that moves, by the library where the graphics processor cannot. */
function drawSoon(i) {
  askDraw();
  if (isInGesture && !isMovedByGpu(i)) askSphere(i);
}

/** Numbers of 16 bits, of which an answer has the bytes, the lower one first. */
function halvesOf(text) {
  const bytes = atob(text);
  const halves = new Uint16Array(bytes.length / 2);
  for (let i = 0; i < halves.length; ++i) halves[i] = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8);
  return halves;
}

/** Textures take longer: the library draws drafts while a slider moves, and the texture is made when it rests. */
function learnTexture(i) {
  const part = gpuParts[i];
  if (!part.needsTexture || part.judgedText !== part.text || isInGesture || part.textureText === part.text) return;
  const { text } = part;
  part.textureText = text;
  ask(`texture ${i}`, "texture", { material: text }, (answer, error) => {
    if (gpuParts[i] !== part || part.text !== text || !part.needsTexture) return;
    if (error !== null || answer.reason !== undefined) return;
    const { texels, ...shader } = answer;
    part.shader = { ...shader, numbers: halvesOf(texels) };
    learnSky(i);
    askDraw();
  }, true);
}

/** Skies of all but isotropic formulas take longer: while a slider moves, the one of before will do. */
function learnSky(i) {
  const part = gpuParts[i];
  if (part.shader === undefined || part.skyText === part.text || lightsAsked().sky === undefined) return;
  if (isInGesture && !hasQuickSky(part.shader) && part.skyText !== undefined) return;
  part.skyText = part.text;
  ask(`sky ${i}`, "sky", { material: part.text }, (answer, error) => {
    if (gpuParts[i] !== part) return;
    if (error === null) part.sky = answer;
    else delete part.sky;
    drawSoon(i);
  });
}

/** Asks the library for a sphere. */
function askSphere(i) {
  const [canvas, caption] = sphereFigures()[i].children;
  const name = i === 0 ? "grey reference" : letterOf(i - 1);
  canvas.setAttribute("aria-label", `sphere of ${name}`);
  if (isInGesture && isMovedByGpu(i)) return;
  const size = isInGesture ? draftSize : spherePixels();
  ask(`sphere ${i}`, "sphere", { material: sphereTexts()[i], lights: lightsAsked(), size }, (answer, error) => {
    if (error !== null) {
      caption.textContent = `${name}: ${error.message}`;
      canvas.getContext("2d").clearRect(0, 0, canvas.width, canvas.height);
      return;
    }
    if (isInGesture && isMovedByGpu(i)) return;
    drawSphere(canvas, answer);
    const share = (100 * answer.clipped) / answer.pixels;
    caption.textContent = share > 0 ? `${name}; ${general(share, 2)} % too bright` : name;
  });
}

function showSpheres() {
  const texts = sphereTexts();
  while (gpuParts.length > texts.length) {
    gpuParts.pop();
    forget(`texture ${gpuParts.length}`);
    forget(`sky ${gpuParts.length}`);
  }
  texts.forEach((text, i) => learnSphere(i, text));
  if (gpu !== null) {
    ask("exposure", "exposure", { lights: lightsAsked() }, (answer) => {
      if (answer !== null) exposure = answer.exposure;
      askDraw();
    });
  }
  askDraw();
  texts.forEach((_, i) => askSphere(i));
}

/** All spheres beside each other. */
function saveSpheres() {
  const canvases = [...document.querySelectorAll("#sphere-row canvas")];
  const whole = document.createElement("canvas");
  whole.width = canvases.reduce((sum, one) => sum + one.width, 0);
  whole.height = Math.max(...canvases.map((one) => one.height));
  let x = 0;
  for (const one of canvases) {
    whole.getContext("2d").drawImage(one, x, 0);
    x += one.width;
  }
  whole.toBlob((blob) => save("spheres.png", blob));
}
