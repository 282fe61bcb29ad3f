// Reads messages (XCDR1) with the schema that the bridge sends for a topic.
'use strict';
Goshawk.Schema = class {
  // @param text ROS 2 .msg text, inner types behind lines of '=' and "MSG: package/Name"
  constructor(text) {
    this.types = new Map();
    let fields = [];
    let constants = [];  // [name, value] of the field that follows
    this.root = fields;
    for (const raw of text.split('\n')) {
      const line = raw.split('#')[0].trim();
      if (!line) continue;
      if (line.startsWith('=')) { fields = []; continue; }
      if (line.startsWith('MSG:')) { this.types.set(line.slice(4).trim(), fields); continue; }
      const constant = line.match(/^\w+\s+(\w+)\s*=\s*(\d+)$/);
      if (constant) { constants.push([constant[1], Number(constant[2])]); continue; }
      const match = line.match(/^([\w/]+)(\[(\d*)\])?\s+(\w+)$/);
      if (match) {
        fields.push({type: match[1], name: match[4],
                     arity: match[2] === undefined ? 'single' : match[3] ? 'array' : 'sequence',
                     size: Number(match[3] || 0), words: this.words(match[4], constants)});
        constants = [];
      }
    }
  }

  // A value with a constant is read as its word: STATE_ARRIVED of the field `state` is 'arrived'.
  words(field, constants) {
    return new Map(constants.map(([name, value]) => [value, name.slice(field.length + 1).toLowerCase()]));
  }

  read(view) {
    this.view = view;
    this.little = view.getUint8(1) === 1;
    this.at = 4;
    return this.struct(this.root);
  }

  struct(fields) {
    const value = {};
    for (const field of fields) {
      const read = this.field(field);
      value[field.name] = field.words.get(read) ?? read;
    }
    return value;
  }

  field({type, arity, size}) {
    if (arity === 'single') return this.one(type);
    const count = arity === 'array' ? size : this.number('uint32');
    const primitive = Goshawk.Schema.sizes[type];
    if (primitive && count * primitive > this.view.byteLength - this.at) throw new Error('cut off');
    if (type === 'uint8' || type === 'int8') return this.bytes(count);
    // 64-bit words are bits of a map here: they stay bytes.
    if (type === 'uint64') { this.align(count ? 8 : 1); return this.bytes(8 * count); }
    const list = [];
    for (let k = 0; k < count; ++k) list.push(this.one(type));
    return list;
  }

  bytes(count) {
    const begin = this.view.byteOffset + this.at;
    this.at += count;
    return new Uint8Array(this.view.buffer, begin, count);
  }

  one(type) {
    if (type === 'string') {
      const bytes = this.bytes(this.number('uint32'));
      return new TextDecoder().decode(bytes.subarray(0, Math.max(0, bytes.length - 1)));
    }
    const inner = this.types.get(type);
    return inner ? this.struct(inner) : this.number(type);
  }

  align(size) { this.at = 4 + Math.ceil((this.at - 4) / size) * size; }

  number(type) {
    const size = Goshawk.Schema.sizes[type];
    if (!size) throw new Error('unknown type ' + type);
    this.align(size);
    const at = this.at, view = this.view, little = this.little;
    this.at += size;
    switch (type) {
      case 'bool': return view.getUint8(at) !== 0;
      case 'int8': return view.getInt8(at);
      case 'uint8': return view.getUint8(at);
      case 'int16': return view.getInt16(at, little);
      case 'uint16': return view.getUint16(at, little);
      case 'int32': return view.getInt32(at, little);
      case 'uint32': return view.getUint32(at, little);
      case 'int64': return Number(view.getBigInt64(at, little));
      case 'uint64': return Number(view.getBigUint64(at, little));
      case 'float32': return view.getFloat32(at, little);
      default: return view.getFloat64(at, little);
    }
  }
};
Goshawk.Schema.sizes = {bool: 1, int8: 1, uint8: 1, int16: 2, uint16: 2, int32: 4, uint32: 4, int64: 8,
                        uint64: 8, float32: 4, float64: 8};
