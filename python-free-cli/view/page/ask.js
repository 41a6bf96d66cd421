"use strict";
// Questions to the server. Each fills a slot of the page: while its answer is made, only the newest further question of
// the slot is kept, and answers to older ones are not shown.

const pageMark = Math.random().toString(36).slice(2);
const slots = new Map();
let asked = 0;
let open = 0;

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

/** Sends a question. \return its answer; null: nobody waits for it any more. \throws Error with the server's line */
async function send(kind, question, slot, signal) {
  asked += 1;
  const response = await fetch(`ask/${kind}`, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ ...question, slot: slot === "" ? "" : `${pageMark} ${slot}`, number: asked }),
    signal,
  });
  const answer = await response.json();
  if (answer.stale) return null;
  if (answer.error !== undefined) throw new Error(answer.error);
  return answer;
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

/**
 * Asks, and shows the answer: `show(answer, error)` with one of them null. A newer question of the slot replaces one
 * that waits; with `isSlow` also the one that is being answered. The page counts as settled while it `isQuiet`.
 * `onProgress(share, best)` is told now and then how far the answer is, and of the best so far where it has one.
 */
async function ask(slot, kind, question, show, isSlow = false, isQuiet = false, onProgress = null) {
  const place = slots.get(slot) ?? { busy: null, next: null };
  slots.set(slot, place);
  if (place.busy !== null) {
    place.next = { kind, question, show, onProgress };
    if (isSlow) place.busy.abort();
    return;
  }
  place.busy = new AbortController();
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
