// `vobench export --mcap`, read back by the MCAP library and by a reader of ROS 2 messages.
// Usage: node mcap_read.mjs VOBENCH MODULES     MODULES has node_modules; the scenes are beside it
// Exit:  0 for success, 1 for a failure.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { open } from "node:fs/promises";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

const [program, modules] = process.argv.slice(2, 4).map((path) => resolve(path));
const load = createRequire(join(modules, "package.json"));
const { McapIndexedReader, McapStreamReader } = load("@mcap/core");
const { parse } = load("@foxglove/rosmsg");
const { MessageReader } = load("@foxglove/rosmsg2-serialization");
const here = mkdtempSync(join(tmpdir(), "vobench-mcap-"));
const run = (...words) => execFileSync(program, words, { cwd: here, stdio: ["ignore", "ignore", "inherit"] });

const lens = "width: 640, height: 480, fx: 525, fy: 520, cx: 319.5, cy: 239.5";
const scenario = readFileSync(join(modules, "../scenes/tiny.yaml"), "utf8")
  .replace(/^camera:.*$/m, `cameras:\n  - {name: left, ${lens}}\n  - {name: right, ${lens}, position: [0.1, 0, 0], trigger_offset: 5 ms}`)
  .replace(/^sensor:.*$/m, "sensor: {time_samples: 1}")
  .replaceAll("file: room/", `file: ${resolve(modules, "../scenes/room")}/`);
writeFileSync(join(here, "rig.yaml"), scenario);
run("render", "rig.yaml", "-o", "seq", "--frames", "0:4", "--truth", "depth,imu");
run("export", "seq", "--mcap", "seq.mcap");

// All messages in order of time, by the index.
const bytes = readFileSync(join(here, "seq.mcap"));
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
};
const reader = await McapIndexedReader.Initialize({ readable });
assert.equal(reader.header.profile, "ros2");
assert(reader.chunkIndexes.length > 2, "several chunks");
const decoders = new Map();
for (const [id, schema] of reader.schemasById) {
  assert.equal(schema.encoding, "ros2msg");
  decoders.set(id, new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true })));
}
const messages = new Map();
let last = -1n;
for await (const message of reader.readMessages()) {
  assert(message.logTime >= last);
  last = message.logTime;
  const { topic, schemaId, messageEncoding } = reader.channelsById.get(message.channelId);
  assert.equal(messageEncoding, "cdr");
  const content = decoders.get(schemaId).readMessage(message.data);
  assert.equal(BigInt(content.header.stamp.sec) * 1_000_000_000n + BigInt(content.header.stamp.nanosec), message.logTime);
  if (!messages.has(topic)) messages.set(topic, []);
  messages.get(topic).push({ time: message.logTime, ...content });
}
const counts = Object.fromEntries([...messages].map(([topic, list]) => [topic, list.length]).sort());
const imu = readFileSync(join(here, "seq/imu0/data.csv"), "utf8").trim().split("\n").slice(1);
assert.deepEqual(counts, {
  "/cam0/camera_info": 4, "/cam0/depth/image_raw": 4, "/cam0/image_raw": 4,
  "/cam1/camera_info": 4, "/cam1/depth/image_raw": 4, "/cam1/image_raw": 4,
  "/ground_truth/pose": 4, "/imu0": imu.length,
});
const total = Object.values(counts).reduce((a, b) => a + b);
assert.equal(reader.statistics.messageCount, BigInt(total));

// Contents of the messages.
messages.get("/cam1/image_raw").forEach((image, k) => {
  assert.equal(image.time, BigInt(Math.round((k * 1e9) / 30)) + 5_000_000n);
  assert.deepEqual([image.width, image.height, image.encoding, image.step], [640, 480, "bgr8", 1920]);
  assert.equal(image.data.length, 480 * 1920);
  assert.equal(image.header.frame_id, "cam1");
  assert(new Set(image.data).size > 50, "it shows something");
});
const depth = messages.get("/cam0/depth/image_raw")[0];
assert.equal(depth.encoding, "32FC1");
const metres = new Float32Array(depth.data.slice().buffer);
assert(metres.every((Z) => Math.abs(Math.round(Z * 5000) / 5000 - Z) < 1e-6) && metres.some((Z) => Z > 1));
const info = messages.get("/cam0/camera_info")[0];
assert.deepEqual([...info.k], [525, 0, 319.5, 0, 520, 239.5, 0, 0, 1]);
assert.deepEqual([...info.d], [0, 0, 0, 0, 0]);
assert.equal(info.p[10], 1);
messages.get("/imu0").forEach((reading, k) => {
  const [t, ...numbers] = imu[k].split(",").map(Number);
  const { angular_velocity: w, linear_acceleration: f } = reading;
  assert.equal(Number(reading.time), t);
  assert.deepEqual([w.x, w.y, w.z, f.x, f.y, f.z], numbers);
  assert.equal(reading.orientation_covariance[0], -1);
});
const poses = readFileSync(join(here, "seq/left/groundtruth.txt"), "utf8").trim().split("\n").slice(1);
messages.get("/ground_truth/pose").forEach(({ pose: { position: p, orientation: q } }, k) => {
  const numbers = poses[k].split(" ").slice(1).map(Number);
  [p.x, p.y, p.z, q.x, q.y, q.z, q.w].forEach((x, i) => assert(Math.abs(x - numbers[i]) < 1e-11));
});

// Read as a stream, without the index: the same number of messages.
const stream = new McapStreamReader();
const file = await open(join(here, "seq.mcap"));
let streamed = 0;
for await (const part of file.createReadStream()) {
  stream.append(part);
  for (let record; (record = stream.nextRecord()); ) streamed += record.type === "Message";
}
assert(stream.done());
assert.equal(streamed, total);
rmSync(here, { recursive: true });
console.log(`${total} messages in ${reader.chunkIndexes.length} chunks`);
