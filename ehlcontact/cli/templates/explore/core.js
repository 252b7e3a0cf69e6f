// The C core of reduced_models, with the functions of bearing.c, as WebAssembly. Every bearing has an instance, whose memory goes with it.

const MODULE = new WebAssembly.Module(bytes(DATA.core));

class Core {
  constructor() {
    this.c = new WebAssembly.Instance(MODULE).exports;
    this.c._initialize();
  }

  // Pointer to numbers, which stay there.
  put(numbers) {
    const at = this.c.numbers(numbers.length);
    new Float64Array(this.c.memory.buffer, at, numbers.length).set(numbers);
    return at;
  }

  // So many numbers from a pointer on.
  read(at, count) {
    return Array.from(new Float64Array(this.c.memory.buffer, at, count));
  }

  // Text that a function returns where it has no answer: null where it has one.
  text(at) {
    if (at === 0) return null;
    const letters = new Uint8Array(this.c.memory.buffer, at), end = letters.indexOf(0);
    return new TextDecoder().decode(letters.slice(0, end));
  }
}
