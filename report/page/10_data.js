/* What the report's program has left: a document of JSON, and one block of bytes that it refers to (report/document.h). */

async function readBlock(text) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/* The numbers that were kept as differences: from the row before, in the first row from `stride` before. */
function unpackIntegers(block, ref, size) {
  const count = ref.rows * ref.width, numbers = new Int32Array(count), mask = size === 4 ? -1 : (1 << (8 * size)) - 1;
  for (let i = 0; i < count; i++) {
    let difference = 0;
    for (let b = 0; b < size; b++) difference |= block[ref.at + b * count + i] << (8 * b);
    const back = i < ref.width ? ref.stride : ref.width;
    numbers[i] = (difference + (i >= back ? numbers[i - back] : 0)) & mask;
  }
  return numbers;
}

function unpack(block, ref) {
  if (ref.type === "i32") return unpackIntegers(block, ref, 4);
  const size = ref.type === "q8" ? 1 : 2, top = size === 1 ? 254 : 65534, step = ref.log ? Math.log(ref.high / ref.low) / top : (ref.high - ref.low) / top;
  return Float32Array.from(unpackIntegers(block, ref, size), (q) => (q > top ? NaN : ref.log ? ref.low * Math.exp(q * step) : ref.low + q * step));
}

/* The same document with arrays where it has references: {rows, width, low, high, log, data}. */
function resolve(block, value) {
  if (Array.isArray(value)) return value.map((one) => resolve(block, one));
  if (value === null || typeof value !== "object") return value;
  if ("at" in value && "stride" in value) return { ...value, data: unpack(block, value) };
  return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, resolve(block, one)]));
}

async function readDocument() {
  const block = await readBlock(document.getElementById("block").textContent);
  return resolve(block, JSON.parse(document.getElementById("document").textContent));
}

/* The least and the greatest number. */
function extent(values) {
  let low = Infinity, high = -Infinity;
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return { low, high };
}

/* ---- Numbers as people read them ---- */

const PREFIXES = { "-12": "p", "-9": "n", "-6": "\u00b5", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G" };
const PREFIXED = /^(m|N|T|J|Pa|A\/m|s|Hz|W|N m|V)$/;

/* The unit in which a number of that size is said, with a prefix where it takes one, and how large it is: "mm", 1e-3. */
function prefixed(size, unit) {
  const power = 3 * Math.floor(Math.log10(Math.abs(size).toPrecision(3)) / 3 + 1e-9); // of what is said
  return PREFIXED.test(unit) && power in PREFIXES ? { unit: PREFIXES[power] + unit, scale: 10 ** power } : { unit, scale: 1 };
}

/* Three digits: "12.5 mm". */
function say(value, unit) {
  if (!Number.isFinite(value)) return "\u2013";
  const named = prefixed(value, unit);
  return `${trim(value / named.scale)} ${named.unit}`.trim();
}

function trim(value) {
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) return Number(value.toPrecision(3)).toExponential();
  return String(Number(value.toPrecision(3)));
}
