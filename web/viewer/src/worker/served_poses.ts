// The poses of a recording, decoded by the server that has the file (`gyre view`): with ?scene the server says what there is to see,
// with ?frames=N it sends the Nth group of frames. Each answer is a JSON text and the arrays that it names by their place behind it
// (apps/gyre/view/served_recording.h). See poses.ts.
import type { BodyType, Quat, ShapeDescription, ShapeGeometry, SoftKind, Surface, Vec3 } from '../protocol';
import type { Model, PoseFrame, PoseLabel, PoseSource, SoftSurface } from './poses';
import { fans, grid } from './triangles';

type Place = [begin: number, count: number]; // of an array: bytes behind the JSON, elements

interface SceneAnswer {
  frames: number;
  group: number; // frames a group
  truncated: boolean;
  time_step: number;
  origin: Vec3;
  accuracy: { position: number; orientation: number };
  note: string;
  models: { type: BodyType; shapes: { geometry: ShapeGeometry; position: Vec3; rotation: Quat; sensor: boolean }[] }[];
  surfaces: SurfaceAnswer[];
  softs: { kind: SoftKind; radius: number; vertices: number; triangles: Place }[];
}
type SurfaceAnswer = { key: string } & (
  | { kind: 'hull'; vertices: Place; face_offsets: Place; face_indices: Place }
  | { kind: 'mesh'; vertices: Place; indices: Place }
  | { kind: 'height_field'; heights: Place; columns: number; rows: number; spacing: number }
);

interface FramesAnswer {
  frames: { step: number; time: number; set: number; poses: Place; awake: Place; vertices: Place }[];
  sets: Record<string, Members & { models: number[]; soft: Members & { surfaces: number[] } }>;
}
interface Members {
  ids: number[];
  names: string[];
  colors: number[][];
}

const MOST_KEPT = 128e6; // bytes of groups that were fetched

class Answer<T> {
  readonly json: T;
  private readonly begin: number;

  constructor(private readonly bytes: ArrayBuffer) {
    const length = new DataView(bytes).getUint32(0, true);
    this.json = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length))) as T;
    this.begin = 4 + length;
  }

  get size(): number {
    return this.bytes.byteLength;
  }
  floats([at, count]: Place): Float32Array {
    return new Float32Array(this.bytes, this.begin + at, count);
  }
  integers([at, count]: Place): Uint32Array {
    return new Uint32Array(this.bytes, this.begin + at, count);
  }
  octets([at, count]: Place): Uint8Array {
    return new Uint8Array(this.bytes, this.begin + at, count);
  }
}

type Group = Answer<FramesAnswer>;

export class ServedPoses implements PoseSource {
  readonly frames: number;
  readonly truncated: boolean;
  readonly timeStep: number;
  readonly origin: Vec3;
  readonly accuracy: { position: number; orientation: number };
  readonly note: string;
  private readonly models: Model[];
  private readonly softs: SoftSurface[];
  private readonly surfaces: Map<string, Surface>;
  private readonly perGroup: number;
  private readonly labels = new Map<number, PoseLabel>();
  private readonly softLabels = new Map<number, PoseLabel>();
  private readonly groups = new Map<number, Group | Promise<Group>>(); // the one used last comes last
  private surfacesTaken = false;

  private constructor(
    private readonly url: string,
    answer: Answer<SceneAnswer>,
  ) {
    const { json } = answer;
    this.frames = json.frames;
    this.truncated = json.truncated;
    this.timeStep = json.time_step;
    this.origin = json.origin;
    this.accuracy = json.accuracy;
    this.note = json.note;
    this.perGroup = json.group;
    this.models = json.models.map(({ type, shapes }) => ({
      type,
      shapes: shapes.map((shape): ShapeDescription => ({ ...shape, material: '', color: null })),
    }));
    this.softs = json.softs.map((soft) => ({ ...soft, triangles: answer.integers(soft.triangles) }));
    this.surfaces = new Map(json.surfaces.map((surface) => [surface.key, triangles(surface, answer)]));
  }

  static async open(url: string): Promise<ServedPoses> {
    return new ServedPoses(url, await ask<SceneAnswer>(url, 'scene'));
  }

  // The group that follows is asked for while this one is shown.
  frame(index: number): PoseFrame | Promise<PoseFrame> {
    const number = Math.floor(index / this.perGroup);
    const inside = index % this.perGroup;
    const group = this.group(number);
    if ((number + 1) * this.perGroup < this.frames) Promise.resolve(this.group(number + 1)).catch(() => undefined);
    return group instanceof Promise ? group.then((loaded) => this.read(loaded, inside)) : this.read(group, inside);
  }

  private group(number: number): Group | Promise<Group> {
    const known = this.groups.get(number);
    this.groups.delete(number);
    const group = known ?? this.fetchGroup(number);
    this.groups.set(number, group);
    return group;
  }

  private async fetchGroup(number: number): Promise<Group> {
    try {
      const group = await ask<FramesAnswer>(this.url, `frames=${number}`);
      for (const set of Object.values(group.json.sets)) {
        keepLabels(this.labels, set);
        keepLabels(this.softLabels, set.soft);
      }
      if (this.groups.has(number)) this.groups.set(number, group);
      this.forgetSome();
      return group;
    } catch (error) {
      this.groups.delete(number); // the next one who wants it asks again
      throw error;
    }
  }

  private forgetSome(): void {
    let size = 0;
    for (const group of this.groups.values()) if (group instanceof Answer) size += group.size;
    for (const [number, group] of this.groups) {
      if (size < MOST_KEPT || this.groups.size <= 3) return;
      if (!(group instanceof Answer)) continue;
      size -= group.size;
      this.groups.delete(number);
    }
  }

  private read(group: Group, inside: number): PoseFrame {
    const { step, time, set, poses, awake, vertices } = group.json.frames[inside]!;
    const { ids, models, soft } = group.json.sets[set]!;
    const softly = { softIds: soft.ids, softs: soft.surfaces, softVertices: group.floats(vertices) };
    return { step, time, set, ids, models, awake: group.octets(awake), poses: group.floats(poses), ...softly };
  }

  model(index: number): Model {
    return this.models[index]!;
  }

  label(id: number): PoseLabel {
    return this.labels.get(id) ?? { name: '', colors: [] };
  }

  soft(index: number): SoftSurface {
    return this.softs[index]!;
  }

  softLabel(id: number): PoseLabel {
    return this.softLabels.get(id) ?? { name: '', colors: [] };
  }

  vertices(surface: string): Float32Array | undefined {
    return this.surfaces.get(surface)?.vertices;
  }

  takeSurfaces(): Surface[] {
    const taken = this.surfacesTaken ? [] : [...this.surfaces.values()];
    this.surfacesTaken = true;
    return taken;
  }

  close(): void {
    this.groups.clear();
  }
}

function keepLabels(labels: Map<number, PoseLabel>, { ids, names, colors }: Members): void {
  ids.forEach((id, row) => labels.set(id, { name: names[row]!, colors: colors[row]! }));
}

async function ask<T>(url: string, question: string): Promise<Answer<T>> {
  let response: Response;
  try {
    response = await fetch(`${url}?${question}`);
  } catch {
    throw new Error('The server does not answer: gyre view was ended.');
  }
  if (!response.ok) throw new Error((await response.text()).trim() || `The server answered ${response.status}.`);
  if (response.headers.get('Content-Type') !== 'application/vnd.gyre.poses') {
    throw new Error('This page was built without the engine, and this server only hands out files. Serve the recording with: gyre view');
  }
  return new Answer<T>(await response.arrayBuffer());
}

function triangles(surface: SurfaceAnswer, answer: Answer<SceneAnswer>): Surface {
  const { key, kind } = surface;
  switch (surface.kind) {
    case 'hull':
      return { key, kind: 'hull', vertices: answer.floats(surface.vertices), indices: fans(answer.integers(surface.face_offsets), answer.octets(surface.face_indices)) };
    case 'mesh':
      return { key, kind: 'mesh', vertices: answer.floats(surface.vertices), indices: answer.integers(surface.indices) };
    default:
      return { key, kind: kind as 'height_field', ...grid(answer.floats(surface.heights), surface.columns, surface.rows, surface.spacing) };
  }
}
