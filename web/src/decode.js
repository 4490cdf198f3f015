// Reads what report/pack.cpp wrote: base64, gzip, then arrays with the bytes of equal rank together.

const holders = new Map();

/** The text of chunk `id`, from the page. */
function chunkText(id) {
  if (!holders.has(id)) holders.set(id, document.getElementById(`talus-${id}`));
  const element = holders.get(id);
  if (!element) throw new Error(`the page has no data "${id}": it is cut off`);
  return element.textContent;
}

/** Bytes of chunk `id`, uncompressed. */
export async function chunk(id) {
  const text = atob(chunkText(id));
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export async function chunkJson(id) {
  return JSON.parse(new TextDecoder().decode(await chunk(id)));
}

// all half-precision numbers
const half = new Float32Array(65536);
for (let i = 0; i < 65536; ++i) {
  const exponent = (i >> 10) & 31, mantissa = i & 1023, sign = i & 0x8000 ? -1 : 1;
  half[i] = exponent === 0 ? sign * mantissa * 2 ** -24
    : exponent === 31 ? (mantissa ? NaN : sign * Infinity)
      : sign * (1 + mantissa / 1024) * 2 ** (exponent - 15);
}

/** Takes arrays off the bytes of a chunk, in the order in which they were packed. */
export class Unpacker {
  constructor(bytes) {
    this.bytes_ = bytes;
    this.at_ = 0;
  }

  bytes(n) {
    if (this.at_ + n > this.bytes_.length) throw new Error("data of the page are cut off");
    this.at_ += n;
    return this.bytes_.subarray(this.at_ - n, this.at_);
  }

  integers(n) {
    return new Int32Array(this.planes(n, 4, 4));
  }

  shortIntegers(n) {
    return new Int16Array(this.planes(n, 2, 2));
  }

  floats(n) {
    return new Float32Array(this.planes(n, 4, 4));
  }

  /** Floats without their lowest byte. */
  shortFloats(n) {
    return new Float32Array(this.planes(n, 4, 3));
  }

  doubles(n) {
    return new Float64Array(this.planes(n, 8, 8));
  }

  /** Half-precision numbers as they are. */
  plainHalves(n) {
    const high = this.bytes(n), low = this.bytes(n), out = new Float32Array(n);
    for (let i = 0; i < n; ++i) out[i] = half[(high[i] << 8) | low[i]];
    return out;
  }

  /** Half-precision numbers behind their common scale. */
  halves(n) {
    const scale = new DataView(this.bytes(4).slice().buffer).getFloat32(0, true);
    const high = this.bytes(n), low = this.bytes(n), out = new Float32Array(n);
    for (let i = 0; i < n; ++i) out[i] = half[(high[i] << 8) | low[i]] * scale;
    return out;
  }

  // a buffer of n little-endian numbers of `width` bytes, of which the `kept` highest were packed
  planes(n, width, kept) {
    const out = new Uint8Array(n * width);
    for (let rank = width - 1; rank >= width - kept; --rank) {
      const plane = this.bytes(n);
      for (let i = 0, to = rank; i < n; ++i, to += width) out[to] = plane[i];
    }
    return out.buffer;
  }
}
