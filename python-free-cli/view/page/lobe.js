"use strict";
// Lobes in space: the values of all directions of view as distances, for the light of the plane of incidence.

const lobes = [];
const lobeSize = 240;

/** A point of space as a viewer sees it who has gone about the normal by `turn` and up by `lift` degrees. */
function seen([x, y, z]) {
  const turn = radians(state.eye.turn);
  const lift = radians(state.eye.lift);
  const right = x * Math.cos(turn) + y * Math.sin(turn);
  const away = -x * Math.sin(turn) + y * Math.cos(turn);
  return { x: right, y: z * Math.cos(lift) + away * Math.sin(lift), depth: away * Math.cos(lift) - z * Math.sin(lift) };
}

const spherePoint = (theta, phi, distance = 1) => [
  distance * Math.sin(radians(theta)) * Math.cos(radians(phi)),
  distance * Math.sin(radians(theta)) * Math.sin(radians(phi)),
  distance * Math.cos(radians(theta)),
];

function drawLobe(canvas, answer, colour, place) {
  const scale = Math.min(2, Math.ceil(window.devicePixelRatio || 1));
  canvas.width = lobeSize * scale;
  canvas.height = lobeSize * scale;
  const paint = canvas.getContext("2d");
  paint.scale(scale, scale);
  const on = (point) => {
    const { x, y } = seen(point);
    return [lobeSize / 2 + x * lobeSize * 0.46, lobeSize * 0.62 - y * lobeSize * 0.46];
  };
  const line = (points, stroke, width) => {
    paint.beginPath();
    points.map(on).forEach(([x, y], i) => (i === 0 ? paint.moveTo(x, y) : paint.lineTo(x, y)));
    paint.strokeStyle = stroke;
    paint.lineWidth = width;
    paint.stroke();
  };
  const style = getComputedStyle(document.documentElement);
  const grid = style.getPropertyValue("--line");
  const circle = [];
  for (let phi = 0; phi <= 360; phi += 5) circle.push(spherePoint(90, phi));
  line(circle, grid, 1);

  // Patches of the surface from the farthest to the nearest, lighter where they face the viewer.
  const rings = answer.theta_out.length;
  const sectors = answer.delta_phi.length;
  const points = answer.theta_out.map((theta, i) => answer.delta_phi.map((delta, j) =>
    spherePoint(theta, state.phi + delta, Math.max(place(number(answer.values[i * sectors + j])), 0))));
  const patches = [];
  for (let i = 0; i + 1 < rings; i += 1) {
    for (let j = 0; j < sectors; j += 1) {
      const next = (j + 1) % sectors;
      const corners = [points[i][j], points[i][next], points[i + 1][next], points[i + 1][j]].map(seen);
      const across = [corners[2].x - corners[0].x, corners[2].y - corners[0].y];
      const along = [corners[3].x - corners[1].x, corners[3].y - corners[1].y];
      const depths = [corners[2].depth - corners[0].depth, corners[3].depth - corners[1].depth];
      const facing = across[0] * along[1] - across[1] * along[0];
      const size = Math.hypot(facing, across[1] * depths[1] - depths[0] * along[1], depths[0] * along[0] - across[0] * depths[1]);
      const depth = corners.reduce((sum, one) => sum + one.depth, 0);
      if (size > 0) patches.push({ corners, depth, light: Math.abs(facing) / size });
    }
  }
  patches.sort((a, b) => b.depth - a.depth);
  const parts = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  for (const { corners, light } of patches) {
    paint.beginPath();
    const middle = { x: corners.reduce((sum, one) => sum + one.x, 0) / 4, y: corners.reduce((sum, one) => sum + one.y, 0) / 4 };
    corners.forEach((corner, i) => {
      // A little larger, so that nothing shows between patches.
      const size = Math.hypot(corner.x - middle.x, corner.y - middle.y) * lobeSize * 0.46;
      const grown = 1 + (size > 0 ? 0.35 / size : 0);
      const x = lobeSize / 2 + (middle.x + (corner.x - middle.x) * grown) * lobeSize * 0.46;
      const y = lobeSize * 0.62 - (middle.y + (corner.y - middle.y) * grown) * lobeSize * 0.46;
      if (i === 0) paint.moveTo(x, y);
      else paint.lineTo(x, y);
    });
    paint.closePath();
    const shade = parts.map((part) => Math.round(part * (0.45 + 0.55 * light)));
    paint.fillStyle = `rgb(${shade.join(" ")})`;
    paint.fill();
  }
  line([[0, 0, 0], [0, 0, 1.05]], grid, 1);
  line([[0, 0, 0], spherePoint(state.theta, state.phi, 1.05)], style.getPropertyValue("--accent"), 2);
}

function drawLobes() {
  const row = document.getElementById("lobe-row");
  while (row.children.length > lobes.length) row.lastChild.remove();
  const all = lobes.flatMap((one) => one?.values ?? []).map(number);
  const { place } = heights(all, state.scale);
  const style = getComputedStyle(document.documentElement);
  const finite = all.filter(Number.isFinite);
  const look = [Math.min(...finite), Math.max(...finite), state.scale, state.eye, state.theta, state.phi,
    style.getPropertyValue("--line"), style.getPropertyValue("--accent"), window.devicePixelRatio];
  // Answers come in any order: what waits for its own has a place already.
  Array.from(lobes).forEach((answer, i) => {
    if (row.children.length <= i) row.append(lobeFigure());
    const [canvas, caption] = row.children[i].children;
    canvas.setAttribute("aria-label", `lobe of ${letterOf(i)} for light from ${state.theta}°`);
    caption.textContent = letterOf(i);
    if (answer === null || answer === undefined) return;
    // Where only others have changed, and not so that it is drawn to another scale, it stands there already.
    const drawn = JSON.stringify([look, colours[i]]);
    if (canvas.drawnAnswer === answer && canvas.drawn === drawn) return;
    drawLobe(canvas, answer, colours[i], place);
    canvas.drawnAnswer = answer;
    canvas.drawn = drawn;
  });
}

function lobeFigure() {
  const figure = document.createElement("figure");
  const canvas = document.createElement("canvas");
  canvas.setAttribute("role", "img");
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons !== 1) return;
    change((now) => {
      now.eye.turn = (((now.eye.turn - event.movementX + 180) % 360) + 360) % 360 - 180;
      now.eye.lift = Math.min(Math.max(now.eye.lift + event.movementY, 0), 90);
    }, true);
  });
  canvas.addEventListener("pointerup", endGesture);
  figure.append(canvas, document.createElement("figcaption"));
  return figure;
}

function showLobes() {
  lobes.length = state.materials.length;
  state.materials.forEach((text, i) => {
    ask(`lobe ${i}`, "lobe", { material: text, theta_in: state.theta, phi_in: state.phi }, (answer, error, isPart) => {
      if (isShown(i)) lobes[i] = error !== null ? null : answer;
      if (!isPart) drawNext(drawLobes);
    });
  });
}
