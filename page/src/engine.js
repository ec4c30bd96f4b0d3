// The timing engine as the program has it, compiled to WebAssembly (page/engine/engine.cpp).

const NUMBERS_BEFORE_UNITS = 3; // of a pass: time, overhead, limiter

export function bytesOfBase64(text) {
  return Uint8Array.from(atob(text.trim()), (c) => c.charCodeAt(0));
}

export class Engine {
  static async load(bytes) {
    const module = await WebAssembly.compile(bytes);
    const imports = {};
    for (const { module: from, name } of WebAssembly.Module.imports(module))
      (imports[from] ??= {})[name] = () => {
        throw new Error(`the engine called ${name}`);
      };
    const instance = await WebAssembly.instantiate(module, imports);
    return new Engine(instance.exports);
  }

  constructor(exports) {
    this.exports = exports;
    exports._initialize?.();
    this.keys = this.#names("key_names");
    this.units = this.#names("unit_names");
    this.streams = this.#names("stream_names");
    this.passCounts = [];
  }

  #names(name) {
    const start = this.exports[name]();
    const bytes = new Uint8Array(this.exports.memory.buffer, start);
    return new TextDecoder()
      .decode(bytes.subarray(0, bytes.indexOf(0)))
      .trim()
      .split("\n");
  }

  addTrace(bytes, passCount) {
    const room = this.exports.trace_bytes(bytes.length);
    new Uint8Array(this.exports.memory.buffer, room, bytes.length).set(bytes);
    const number = this.exports.add_trace();
    if (number < 0) throw new Error("the trace is of another version than the engine");
    this.passCounts[number] = passCount;
    return number;
  }

  // `values` by key; `slopeKeys`: those by which the time is derived; `passes`: how many, all by default.
  time(trace, values, { slopeKeys = [], passes = this.passCounts[trace] } = {}) {
    const { exports, keys, units, streams } = this;
    new Float64Array(exports.memory.buffer, exports.gpu_values(), keys.length).set(
      keys.map((key) => Number(values[key])),
    );
    const wanted = keys.filter((key) => slopeKeys.includes(key));
    new Uint8Array(exports.memory.buffer, exports.slope_mask(), keys.length).set(
      keys.map((key) => (wanted.includes(key) ? 1 : 0)),
    );
    const start = exports.time_trace(trace, passes);
    const width = NUMBERS_BEFORE_UNITS + 3 * units.length + 2 * streams.length;
    const count = 1 + passes * width + wanted.length;
    const numbers = Array.from(new Float64Array(exports.memory.buffer, start, count));
    let at = 0;
    const take = (n) => numbers.slice(at, (at += n));
    const named = (names) => Object.fromEntries(take(names.length).map((v, i) => [names[i], v]));
    const timeNs = take(1)[0];
    const list = [];
    for (let p = 0; p < passes; ++p) {
      const [passNs, overheadNs, limiter] = take(NUMBERS_BEFORE_UNITS);
      list.push({
        timeNs: passNs,
        overheadNs,
        limiter: units[limiter],
        busyNs: named(units),
        share: named(units),
        stackNs: named(units),
        read: named(streams),
        write: named(streams),
      });
    }
    return { timeNs, passes: list, slopes: named(wanted) };
  }
}
