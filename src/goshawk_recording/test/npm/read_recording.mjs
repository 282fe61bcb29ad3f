// node read_recording.mjs FILE.mcap DUMP.jsonl
//
// Reads a recording with the packages that Foxglove reads it with, through its indices and as a
// stream, and compares every message with what Goshawk says is in it, value by value. Written again,
// each message must have the same bytes from the ROS 2 serialiser and from Goshawk.

import { open, readFile } from "node:fs/promises";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";
import { parse } from "@foxglove/rosmsg";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";

const [path, dumpPath] = process.argv.slice(2);
const decompressHandlers = await loadDecompressHandlers();

class FileReadable {
  constructor(handle) {
    this.handle = handle;
  }
  async size() {
    return BigInt((await this.handle.stat()).size);
  }
  async read(offset, size) {
    const buffer = new Uint8Array(Number(size));
    await this.handle.read(buffer, 0, buffer.length, Number(offset));
    return buffer;
  }
}

const fail = (text) => {
  console.error(text);
  process.exit(1);
};

// Ours has "nan", "inf", "-inf" for what JSON has no number for.
const special = { nan: NaN, inf: Infinity, "-inf": -Infinity };

function compare(theirs, ours, where) {
  if (ours !== null && typeof ours === "object" && !Array.isArray(ours)) {
    for (const [name, value] of Object.entries(ours)) {
      // Time and Duration have the names of ROS 1 in these packages.
      const key = name === "nanosec" && !(name in theirs) ? "nsec" : name;
      if (!(key in theirs)) fail(`${where}.${name} is missing`);
      compare(theirs[key], value, `${where}.${name}`);
    }
  } else if (Array.isArray(ours)) {
    if (theirs.length !== ours.length) fail(`${where}: ${theirs.length} and ${ours.length} elements`);
    for (let i = 0; i < ours.length; i++) compare(theirs[i], ours[i], `${where}[${i}]`);
  } else {
    const left = typeof theirs === "bigint" ? Number(theirs) : theirs;
    const right = typeof left === "number" && typeof ours === "string" ? special[ours] : ours;
    if (!Object.is(left, right) && !(left === 0 && right === 0)) {
      fail(`${where} is ${left} there, ${right} here`);
    }
  }
}

class Types {
  codecs = new Map();
  of(schema) {
    if (schema.encoding !== "ros2msg") fail(`${schema.name} has encoding ${schema.encoding}`);
    let codec = this.codecs.get(schema.id);
    if (codec == undefined) {
      const definition = parse(new TextDecoder().decode(schema.data), { ros2: true });
      codec = { reader: new MessageReader(definition), writer: new MessageWriter(definition) };
      this.codecs.set(schema.id, codec);
    }
    return codec;
  }
}

const dump = (await readFile(dumpPath, "utf8")).split("\n").filter((line) => line !== "");
const expected = dump.map((line) => JSON.parse(line));
const handle = await open(path);
const reader = await McapIndexedReader.Initialize({
  readable: new FileReadable(handle), decompressHandlers });
if (reader.header.profile !== "ros2") fail(`profile is ${reader.header.profile}`);

const types = new Types();
let count = 0;
let rewritten = 0;
for await (const message of reader.readMessages({ validateCrcs: true })) {
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  const want = expected[count++];
  if (want == undefined) fail("more messages there than here");
  const where = `message ${count} of ${channel.topic}`;
  if (channel.messageEncoding !== "cdr") fail(`${where}: ${channel.messageEncoding}`);
  if (!channel.metadata.has("offered_qos_profiles")) fail(`${where}: no quality of service`);
  compare({ topic: channel.topic, type: schema.name, sequence: message.sequence,
            log_time_ns: String(message.logTime), bytes: message.data.length },
          { topic: want.topic, type: want.type, sequence: want.sequence,
            log_time_ns: want.log_time_ns, bytes: want.bytes }, where);
  const { reader: decode, writer: encode } = types.of(schema);
  const value = decode.readMessage(message.data);
  compare(value, want.value, where);
  if (!want.lossy) {
    const again = Buffer.from(encode.writeMessage(value)).toString("hex");
    if (again !== want.again) fail(`${where}: other bytes`);
    rewritten++;
  }
}
if (count !== expected.length) fail(`${count} messages there, ${expected.length} here`);
if (Number(reader.statistics.messageCount) !== count) fail("statistics count otherwise");

// The same through the stream, with every CRC, as a program reads a file that has no end yet.
const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(await readFile(path));
let streamed = 0;
for (let record; (record = stream.nextRecord()); ) if (record.type === "Message") streamed++;
if (!stream.done() || streamed !== count) fail(`stream: ${streamed} messages`);
await handle.close();
console.log(`${count} messages of ${reader.channelsById.size} topics read, ` +
            `${rewritten} written again byte for byte`);
