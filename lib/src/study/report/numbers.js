"use strict";
// Numbers with their errors, as the command prints them.

/** As %g of C: so many digits, no zeros at the end. */
function general(value, digits) {
  if (value === 0) return "0";
  const scientific = value.toExponential(digits - 1);
  const exponent = Number(scientific.slice(scientific.indexOf("e") + 1));
  const withoutZeros = (text) => (text.includes(".") ? text.replace(/\.?0+$/, "") : text);
  if (exponent >= -4 && exponent < digits) return withoutZeros(value.toFixed(digits - 1 - exponent));
  const mantissa = withoutZeros(scientific.slice(0, scientific.indexOf("e")));
  const size = String(Math.abs(exponent)).padStart(2, "0");
  return `${mantissa}e${exponent < 0 ? "-" : "+"}${size}`;
}

/** "0.12345 ± 2.1e-05": one digit more than the error leaves certain. */
function estimateText(value, error) {
  if (!Number.isFinite(value)) return "not known";
  if (Number.isNaN(error)) return `${general(value, 6)} (error unknown)`;
  if (!(error > 0) || !Number.isFinite(error)) return `${value} ± ${error}`;
  const ratio = Math.abs(value) / error;
  const digits = ratio > 1 ? Math.min(Math.floor(Math.log10(ratio)) + 2, 17) : 2;
  return `${general(value, digits)} ± ${general(error, 2)}`;
}

/** A unit behind a number; UDUNITS has no form for the root of a steradian. */
function unitText(unit) {
  if (unit === "1") return "";
  return unit === "sr^0.5" ? " √sr" : ` ${unit}`;
}

/** What JSON has no number for is null. */
function numbers(list) {
  return list.map((value) => (value === null ? NaN : value));
}

/** "1 material", "2 materials". */
function counted(count, one, many = `${one}s`) {
  return `${count} ${count === 1 ? one : many}`;
}
