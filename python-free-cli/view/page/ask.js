"use strict";
// Questions to the server. Each fills a slot of the page: while its answer is made, only the newest further question of
// the slot is kept, and answers to older ones are not shown.

const pageMark = Math.random().toString(36).slice(2);
const slots = new Map();
let asked = 0;
let open = 0;
/** Questions whose answers never change: where the newest of a slot is asked again, nobody has to be asked. */
const lastingKinds = new Set(["plane", "samples", "albedos", "slice", "lobe", "sphere", "sky", "texture", "shader", "check",
  "distances", "composition"]);

/** Infinities and NaN, which JSON lacks, are texts. */
function number(value) {
  return value === "inf" ? Infinity : value === "-inf" ? -Infinity : value === "nan" || value === null ? NaN : value;
}

/** "0.12345 ± 2.1e-05", or the reason why there is no number. */
function told(estimate) {
  if (estimate === undefined) return "";
  if (estimate.reason !== undefined) return estimate.reason;
  const value = number(estimate.value);
  return value === Infinity ? "infinite" : estimateText(value, number(estimate.error));
}

function changeOpen(by) {
  open += by;
  document.body.dataset.busy = open > 0 ? "1" : "0";
  if (open === 0) noteSettled();
}

const wishedDrawings = new Set();

/** Draws for the next picture of the browser, once, however often it is wished for until then. */
function drawNext(draw) {
  if (wishedDrawings.has(draw)) return;
  // Pages that nobody sees have no pictures to wait for.
  if (wishedDrawings.size === 0) (document.hidden ? setTimeout : requestAnimationFrame)(drawWished);
  wishedDrawings.add(draw);
  changeOpen(1);
}

function drawWished() {
  const all = [...wishedDrawings];
  wishedDrawings.clear();
  for (const draw of all) {
    try {
      draw();
    } catch (error) {
      reportError(error); // the others are drawn none the less
    }
    changeOpen(-1);
  }
}

const mostTogether = 100; // what the server takes
const leaving = [];

/**
 * Sends a question, together with all others of this moment: a browser asks a server only six things at a time.
 * \return its answer; null: nobody waits for it any more. \throws Error with the server's line
 */
function send(kind, question, slot, signal) {
  asked += 1;
  const sent = { ...question, kind, slot: slot === "" ? "" : `${pageMark} ${slot}`, number: asked };
  return new Promise((resolve, reject) => {
    signal?.addEventListener("abort", () => reject(signal.reason), { once: true });
    if (leaving.length === 0) queueMicrotask(sendLeaving);
    leaving.push({ sent, resolve, reject });
  });
}

function settle({ resolve, reject }, answer) {
  if (answer.stale) resolve(null);
  else if (answer.error !== undefined) reject(new Error(answer.error));
  else resolve(answer);
}

/** Sends the questions of this moment, and settles each when the line of its answer comes. */
async function sendLeaving() {
  const all = leaving.splice(0, mostTogether);
  if (leaving.length > 0) queueMicrotask(sendLeaving);
  try {
    const response = await fetch("asks", {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ questions: all.map((one) => one.sent) }),
    });
    if (!response.ok) throw new Error((await response.json()).error);
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    let rest = "";
    for (;;) {
      const { value, done } = await reader.read();
      if (done) break;
      const lines = (rest + value).split("\n");
      rest = lines.pop();
      for (const line of lines) {
        const { at, answer } = JSON.parse(line);
        settle(all[at], answer);
      }
    }
    throw new Error("the command broke off before its last answer");
  } catch (error) {
    for (const one of all) one.reject(error); // those that are settled stay so
  }
}

/** Asks how far the answer for a slot is, as long as it is being made. */
async function watchProgress(slot, place, onProgress) {
  const { busy, number } = place;
  for (;;) {
    await new Promise((later) => { setTimeout(later, 300); });
    if (place.busy !== busy) return;
    let answer = null;
    try {
      answer = await send("progress", { of: `${pageMark} ${slot}`, of_number: number }, "");
    } catch {
      return; // who asked is told
    }
    if (place.busy === busy && answer !== null && answer.share !== undefined) onProgress(answer.share, answer.best);
  }
}

const isBeingAsked = (kind) => [...slots.values()].some((place) => place.busy !== null && place.kind === kind);

/**
 * Asks, and shows the answer: `show(answer, error, isPart)` with one of the first two null, and whether a known answer is
 * shown while others of its kind are still to come. A newer question of the slot replaces one
 * that waits; with `isSlow` also the one that is being answered. The page counts as settled while it `isQuiet`.
 * `onProgress(share, best)` is told now and then how far the answer is, and of the best so far where it has one.
 */
async function ask(slot, kind, question, show, isSlow = false, isQuiet = false, onProgress = null) {
  const place = slots.get(slot) ?? { busy: null, next: null, known: null };
  slots.set(slot, place);
  const text = lastingKinds.has(kind) ? `${kind} ${JSON.stringify(question)}` : null;
  if (place.busy === null && text !== null && place.known?.text === text) {
    if (!isQuiet) changeOpen(1);
    queueMicrotask(() => {
      try {
        if (place.busy === null && place.known.text === text) show(place.known.answer, null, isBeingAsked(kind));
      } finally {
        if (!isQuiet) changeOpen(-1);
      }
    });
    return;
  }
  if (place.busy !== null) {
    place.next = { kind, question, show, onProgress };
    if (isSlow) place.busy.abort();
    return;
  }
  place.busy = new AbortController();
  place.kind = kind;
  place.number = asked + 1; // what send() will give the question
  if (onProgress !== null) watchProgress(slot, place, onProgress);
  if (!isQuiet) changeOpen(1);
  let answer = null;
  let error = null;
  try {
    answer = await send(kind, question, slot, place.busy.signal);
  } catch (caught) {
    error = caught;
  }
  place.busy = null;
  if (answer !== null && text !== null) place.known = { text, answer };
  const { next } = place;
  place.next = null;
  if (next !== null) ask(slot, next.kind, next.question, next.show, isSlow, isQuiet, next.onProgress);
  if (error !== null && error.name === "AbortError") error = null;
  if (error instanceof TypeError) error = new Error("the command no longer answers; it was ended, or the computer slept");
  try {
    if (answer !== null || error !== null) show(answer, error);
  } finally {
    if (!isQuiet) changeOpen(-1);
  }
}

/** Nobody waits for this slot any more. */
function forget(slot) {
  const place = slots.get(slot);
  if (place === undefined) return;
  place.next = null;
  if (place.busy === null) return;
  place.busy.abort();
  send("forget", {}, slot).catch(() => {}); // else it would be made to its end
}
