// A scene that is simulated here: steps, commands, the way back, settings, and what the page is told after each.
import { BroadPhaseKind, type Gyre, IntegratorKind, type Scene, SolverKind, type BodyId, type FluidId, type SoftId } from 'gyre-physics';
import type {
  BodyDescription,
  BodyReport,
  Box,
  Command,
  FluidDescription,
  FrameMessage,
  NewWorldSettings,
  OverlayName,
  RunSettings,
  SceneDescription,
  SoftDescription,
  SoftReport,
  Structure,
  Vec3,
  WorldSettings,
} from '../protocol';
import { Describer } from './describe';
import { engineWords } from './engine';
import { extent } from './extent';
import { corners, FluidReader } from './fluids';
import { Hand } from './hand';
import { Keys, worldPart } from './keys';
import { Looks } from './looks';
import { Past } from './past';
import type { SceneText } from './scene_source';
import type { Session } from './session';
import { describeSoft, readSoftVertices, reportOnSoft, softKindName } from './softs';
import { throwableShape } from './throwables';
import { readFlags, readLinks, readOverlays, readRows, readStats, reportOn, withNames } from './world_reader';

const MANY_BODIES = 800; // from here on a second thread pays

// soft_step in scene files, softStep in the engine's interface
const snake = (name: string): string => name.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`);

function nameOf(kinds: Readonly<Record<string, number>>, value: number): string {
  return snake(Object.keys(kinds).find((name) => kinds[name] === value) ?? '');
}

// { field: value } for the value behind such a name, nothing where none is given.
function valueOf<F extends string, T extends Readonly<Record<string, number>>>(field: F, kinds: T, name: string | undefined): { [K in F]?: T[keyof T] } {
  const key = Object.keys(kinds).find((entry) => snake(entry) === name);
  return (key === undefined ? {} : { [field]: kinds[key] }) as { [K in F]?: T[keyof T] };
}

const equal = (a: Float64Array, b: Float64Array): boolean => a.length === b.length && a.every((value, i) => value === b[i]);

export class LiveSession implements Session {
  private scene: Scene;
  private settings: WorldSettings;
  private readonly origin: Vec3;
  private readonly looks: Looks;
  private readonly keys = new Keys();
  private readonly softKeys = new Keys();
  private readonly fluidKeys = new Keys();
  private readonly past = new Past();
  private readonly hand = new Hand();
  private readonly describer: Describer;
  private readonly thrown = new Map<number, string>(); // names of what was added, by key
  private overlays: ReadonlySet<OverlayName> = new Set();
  private ids = new Float64Array(0);
  private types = new Uint8Array(0);
  private softIds = new Float64Array(0);
  private softSizes = new Float64Array(0);
  private fluidIds = new Float64Array(0);
  private readonly fluids: FluidReader;
  private structure = 0;
  private readonly sent = new Set<number>(); // keys of bodies that the page knows
  private appliedHere = 0; // how many of the commands at this step have been done
  private step = 0;
  private stepMs = 0;
  private problem: string | null = null;

  constructor(
    private readonly gyre: Gyre,
    private readonly source: SceneText,
    asked: NewWorldSettings,
  ) {
    const count = source.json.bodies?.length ?? 0;
    const threads = asked.threads ?? (count >= MANY_BODIES ? gyre.maxThreads : 1);
    this.scene = this.openScene({ ...asked, threads });
    this.looks = new Looks(source.json, this.scene);
    this.describer = new Describer(gyre);
    this.origin = this.middle();
    this.fluids = new FluidReader(this.origin);
    this.settings = this.readSettings(threads, asked.simdWidth ?? 0);
    this.scene.sceneBodies.forEach((id) => this.keys.key(id));
    this.scene.sceneSofts.forEach((id) => this.softKeys.key(id));
    this.scene.sceneFluids.forEach((id) => this.fluidKeys.key(id));
    this.past.keep({ step: 0, bytes: this.scene.saveSnapshot(), hand: null });
  }

  private openScene(settings: NewWorldSettings): Scene {
    const { broadPhase, solver, integrator } = settings;
    const scene = this.gyre.openScene(this.source.text, {
      file: this.source.file,
      files: this.source.files,
      threads: settings.threads ?? 1,
      simdWidth: settings.simdWidth ?? 0,
      settings: {
        stepping: {
          ...valueOf('broadPhase', BroadPhaseKind, broadPhase),
          ...valueOf('solver', SolverKind, solver),
          ...valueOf('integrator', IntegratorKind, integrator),
        },
      },
    });
    scene.setTiming(true);
    return scene;
  }

  private readSettings(threads: number, simdWidth: number): WorldSettings {
    const { stepping } = this.scene.def();
    return {
      ...this.runSettings(),
      timeStep: this.scene.timeStep,
      solver: nameOf(SolverKind, stepping.solver),
      integrator: nameOf(IntegratorKind, stepping.integrator),
      broadPhase: nameOf(BroadPhaseKind, stepping.broadPhase),
      threads,
      simdWidth,
    };
  }

  private runSettings(): RunSettings {
    const { gravity, sleeping, stepping } = this.scene.def();
    return { gravity: Array.from(gravity) as Vec3, substeps: stepping.substeps, sleeping };
  }

  // Far from the world's origin, floats are counted from the middle of what there is.
  private middle(): Vec3 {
    const { positions } = this.scene.bodies();
    const middle: Vec3 = [0, 0, 0];
    for (let i = 0; i < positions.length; i++) middle[i % 3]! += (3 * positions[i]!) / positions.length;
    return middle.every((value) => Math.abs(value) < 1000) ? [0, 0, 0] : (middle.map(Math.round) as Vec3);
  }

  describe(): SceneDescription {
    const { gyre } = this;
    const settings = { ...this.settings, ...this.runSettings() };
    return {
      title: this.scene.name || this.source.file,
      notes: this.source.notes,
      file: this.source.file,
      live: true,
      origin: this.origin,
      bounds: this.bounds(),
      view: this.looks.view(this.origin),
      stages: this.scene.readTimes().stages.name,
      settings,
      choices: {
        solver: Object.keys(SolverKind).map(snake),
        integrator: Object.keys(IntegratorKind).map(snake),
        broadPhase: Object.keys(BroadPhaseKind).map(snake),
        simdWidth: gyre.build === 'plain' ? [0] : [0, 1],
        maxThreads: gyre.maxThreads,
      },
      engine: engineWords(gyre, settings.threads, settings.simdWidth),
      lastStep: this.past.lastStep,
      truncated: false,
      posesOnly: '',
    };
  }

  private bounds(): Box {
    const { ids, poses } = readRows(this.scene, this.origin);
    const bodies = Array.from(ids, (id) => this.describer.body(this.scene, id, 0, ''));
    const soft = readSoftVertices(this.scene, this.scene.softs(), this.origin);
    const fluids = Array.from(this.scene.fluids().slice(), (id) => this.describeFluid(id).box);
    return extent(bodies, poses, (surface) => this.describer.vertices(surface), Float32Array.from([...soft, ...corners(fluids)]));
  }

  // -------------------------------------------------------------------------------------------------------------- going on

  advance(steps: number, commands: readonly Command[]): FrameMessage {
    this.problem = null;
    for (const command of commands) this.act(command);
    const begin = performance.now();
    for (let i = 0; i < steps && this.problem === null; i++) this.stepOnce();
    if (steps > 0) this.stepMs = (performance.now() - begin) / steps;
    return this.frame();
  }

  // Something new, now.
  private act(command: Command): void {
    if (this.past.lastStep > this.step || this.past.at(this.step).length > this.appliedHere) this.forgetFuture();
    this.past.add(this.step, this.appliedHere, command);
    this.appliedHere++;
    this.do(command);
  }

  private forgetFuture(): void {
    this.past.cut(this.step);
    this.keys.keepOnly(this.scene.bodies().ids);
    this.softKeys.keepOnly(this.scene.softs());
    this.fluidKeys.keepOnly(this.scene.fluids());
    for (const key of this.thrown.keys()) {
      if (!this.keys.has(key)) this.thrown.delete(key);
    }
  }

  private stepOnce(): void {
    const planned = this.past.at(this.step);
    while (this.appliedHere < planned.length) this.do(planned[this.appliedHere++]!);
    const begin = performance.now();
    try {
      this.scene.step();
    } catch (error) {
      this.problem = (error as Error).message;
    }
    this.step++;
    this.appliedHere = 0;
    this.past.lastStep = Math.max(this.past.lastStep, this.step);
    if (this.past.due(this.step, performance.now() - begin)) {
      this.past.keep({ step: this.step, bytes: this.scene.saveSnapshot(), hand: this.hand.state });
    }
  }

  seek(step: number): FrameMessage {
    const wanted = Math.min(Math.max(step, 0), this.past.lastStep);
    this.problem = null;
    const back = wanted < this.step || (wanted === this.step && this.appliedHere > 0);
    const keyframe = this.past.before(wanted);
    if (back || keyframe.step > this.step) {
      this.scene.restoreSnapshot(keyframe.bytes);
      this.hand.state = keyframe.hand;
      this.step = keyframe.step;
      this.appliedHere = 0;
    }
    while (this.step < wanted && this.problem === null) this.stepOnce();
    return this.frame();
  }

  private do(command: Command): void {
    const { scene } = this;
    const world = this.worldNumber();
    const idOf = (key: number): BodyId => this.keys.id(key, world);
    try {
      switch (command.do) {
        case 'grab':
          return this.hand.grab(scene, idOf(command.key), this.inWorld(command.at));
        case 'grab_soft':
          return this.grabSoft(this.softKeys.id(command.key, world), command);
        case 'pull':
          return this.hand.pull(scene, this.inWorld(command.to));
        case 'release':
          return this.hand.release(scene);
        case 'stir':
        case 'still':
          return this.stir(this.fluidKeys.id(command.key, world), command);
        case 'throw':
          return this.throw(command);
        case 'remove':
          if (this.hand.state?.body === idOf(command.key)) this.hand.release(scene);
          return scene.removeBody(idOf(command.key));
        case 'remove_soft':
          if (this.hand.state?.grip) this.hand.release(scene);
          return scene.removeSoft(this.softKeys.id(command.key, world));
        case 'push':
          return scene.addImpulseAt(idOf(command.key), command.impulse, this.inWorld(command.at));
        case 'wake':
          return scene.setAwake(idOf(command.key), command.awake);
        case 'gravity':
          return this.setGravity(command.value);
        case 'substeps':
          return scene.setSubsteps(command.value);
        case 'sleeping':
          return scene.setSleeping(command.value);
      }
    } catch (error) {
      this.problem = (error as Error).message;
    }
  }

  // As ids of this world carry it; 0 if there is nothing in the world.
  private worldNumber(): number {
    return worldPart(this.scene.bodies().ids[0] ?? this.scene.softs()[0] ?? this.scene.fluids()[0] ?? 0);
  }

  // Vertices that the scene holds stay held; the hand is strong enough for the bodies that hang there.
  private grabSoft(id: SoftId, { key, at }: Extract<Command, { do: 'grab_soft' }>): void {
    const { scene } = this;
    if (!id || !scene.softExists(id)) return;
    const holds = scene.softHolds[key] ?? [];
    const loads = new Set(holds.map(({ body }) => body).filter((body) => body >= 0));
    const load = [...loads].reduce((sum, body) => sum + scene.massProperties(scene.sceneBodies[body]!).mass, 0);
    this.hand.grabSoft(scene, id, this.inWorld(at), new Set(holds.map(({ vertex }) => vertex)), load);
  }

  private stir(id: FluidId, command: Extract<Command, { do: 'stir' | 'still' }>): void {
    if (!id || !this.scene.fluidExists(id)) return;
    if (command.do === 'stir') this.fluids.stir(this.scene, id, this.inWorld(command.at), command.velocity);
    else this.fluids.still(this.scene, id);
  }

  // What sleeps does not feel gravity change by itself.
  private setGravity(gravity: Vec3): void {
    this.scene.setGravity(gravity);
    for (const [row, id] of this.scene.bodies().ids.slice().entries()) {
      if (this.typeOf(id, row) && !this.scene.isAwake(id)) this.scene.setAwake(id, true);
    }
  }

  private typeOf(id: BodyId, row: number): boolean {
    return (this.ids[row] === id ? this.types[row]! : this.scene.type(id)) === 2;
  }

  private throw(command: Extract<Command, { do: 'throw' }>): void {
    const id = this.scene.addBody(
      { pose: { position: this.inWorld(command.from) }, linearVelocity: command.velocity, continuous: true },
      { geometry: throwableShape(command.what, command.size), density: command.density, material: { restitution: 0.2 } },
    );
    const key = this.keys.key(id);
    if (!this.thrown.has(key)) this.thrown.set(key, this.freeName(command.what));
  }

  // "ball 1", or the next number that no body has.
  private freeName(what: string): string {
    const taken = new Set([...this.scene.bodyNames, ...this.thrown.values()]);
    let number = 1;
    while (taken.has(`${what} ${number}`)) number++;
    return `${what} ${number}`;
  }

  private inWorld(place: Vec3): Vec3 {
    return [place[0] + this.origin[0], place[1] + this.origin[1], place[2] + this.origin[2]];
  }

  // ------------------------------------------------------------------------------------------------------------ being seen

  frame(fresh = false): FrameMessage {
    const { scene } = this;
    const rows = readRows(scene, this.origin);
    const softIds = scene.softs().slice();
    const fluidIds = scene.fluids().slice();
    const structure = this.restructure(rows.ids, softIds, fluidIds, fresh);
    return {
      frame: {
        step: this.step,
        time: this.step * this.settings.timeStep,
        lastStep: this.past.lastStep,
        structure: this.structure,
        poses: rows.poses,
        velocities: rows.velocities,
        flags: readFlags(scene, rows.ids, this.types),
        softVertices: readSoftVertices(scene, softIds, this.origin),
        fluids: Array.from(fluidIds, (id) => this.fluids.read(scene, id, this.overlays.has('speed'))),
        stats: readStats(scene, this.stepMs),
        measured: true,
        links: readLinks(scene, this.origin),
        overlays: readOverlays(scene, this.overlays, this.origin, true),
        settings: this.runSettings(),
        problem: this.problem,
      },
      structure,
    };
  }

  private restructure(ids: Float64Array, softIds: Float64Array, fluidIds: Float64Array, fresh: boolean): Structure | null {
    // Soft matter that tears has more vertices.
    const softSizes = Float64Array.from(softIds, (id) => this.scene.vertices(id).x.length);
    if (equal(ids, this.ids) && equal(softIds, this.softIds) && equal(softSizes, this.softSizes) && equal(fluidIds, this.fluidIds) && !fresh) return null;
    if (fresh) this.sent.clear();
    this.ids = ids as Float64Array<ArrayBuffer>;
    this.softIds = softIds as Float64Array<ArrayBuffer>;
    this.softSizes = softSizes;
    this.fluidIds = fluidIds as Float64Array<ArrayBuffer>;
    this.types = Uint8Array.from(ids, (id) => this.scene.type(id));
    this.structure++;
    const keys = Uint32Array.from(ids, (id) => this.keys.key(id));
    const added: BodyDescription[] = [];
    keys.forEach((key, row) => {
      if (this.sent.has(key)) return;
      this.sent.add(key);
      added.push(this.describeBody(ids[row]!, key));
    });
    const softs = Array.from(softIds, (id) => this.describeSoft(id));
    return { number: this.structure, keys, added, surfaces: this.describer.takeSurfaces(), softs, fluids: Array.from(fluidIds, (id) => this.describeFluid(id)) };
  }

  private describeSoft(id: SoftId): SoftDescription {
    const key = this.softKeys.key(id);
    return describeSoft(this.scene, id, { key, name: this.softName(id, key), color: this.scene.softColors[key] ?? null });
  }

  private describeFluid(id: FluidId): FluidDescription {
    const key = this.fluidKeys.key(id);
    const color = this.scene.fluidColors[key] ?? null;
    return this.fluids.describe(this.scene, id, { key, name: this.scene.fluidNames[key] ?? `fluid ${key + 1}`, color });
  }

  private softName(id: SoftId, key: number): string {
    return this.scene.softNames[key] ?? `${softKindName(this.scene.softInfo(id).kind)} ${key + 1}`;
  }

  private describeBody(id: BodyId, key: number): BodyDescription {
    const index = key < this.scene.sceneBodies.length ? key : -1;
    const body = this.describer.body(this.scene, id, key, this.nameOf(key));
    body.shapes.forEach((shape, i) => Object.assign(shape, this.looks.shape(index, i)));
    return body;
  }

  private nameOf(key: number): string {
    return this.scene.bodyNames[key] ?? this.thrown.get(key) ?? 'hand';
  }

  setOverlays(names: readonly OverlayName[]): void {
    this.overlays = new Set(names);
  }

  inspect(key: number): BodyReport | null {
    const id = this.keys.id(key, this.worldNumber());
    if (!id || !this.scene.bodyExists(id)) return null;
    return reportOn(this.gyre, this.scene, id, key, this.nameOf(key), withNames(this.scene.explain(id).words, this.ids, (other) => this.nameOf(this.keys.key(other))));
  }

  inspectSoft(key: number): SoftReport | null {
    const id = this.softKeys.id(key, this.worldNumber());
    return id && this.scene.softExists(id) ? reportOnSoft(this.scene, id, key, this.softName(id, key)) : null;
  }

  // -------------------------------------------------------------------------------------------------------------- settings

  // The same scene in a world of other settings, put to where this one stands. The way back stays open.
  configure(settings: NewWorldSettings): void {
    const snapshot = this.scene.saveSnapshot();
    const next = { ...this.settings, ...settings };
    const changed: NewWorldSettings = {
      threads: next.threads,
      simdWidth: next.simdWidth,
      broadPhase: next.broadPhase,
      solver: next.solver,
      integrator: next.integrator,
    };
    const scene = this.openScene(changed);
    try {
      scene.restoreSnapshot(snapshot);
      // The integrator is a part of the state that came with the snapshot.
      if (next.integrator !== this.settings.integrator) scene.setIntegrator(valueOf('integrator', IntegratorKind, next.integrator).integrator!);
      // The solver is part of the state, so the snapshot brought the old one back.
      const { kind } = valueOf('kind', SolverKind, next.solver);
      if (kind !== undefined) scene.setSolver(kind, scene.def().stepping.solverOptions);
    } catch (error) {
      scene.dispose();
      throw error;
    }
    const before = this.worldNumber();
    this.scene.dispose();
    this.scene = scene;
    this.settings = next;
    const by = this.worldNumber() - before;
    this.past.moveWorld(by);
    this.hand.moveWorld(by);
  }

  hash(): string {
    return this.scene.hash().toString(16).padStart(16, '0');
  }

  save(what: 'scene' | 'snapshot'): { name: string; bytes: Uint8Array } {
    const stem = this.source.file.replace(/\.gyre\.json$/, '');
    if (what === 'snapshot') return { name: `${stem}.gyresnap`, bytes: this.scene.saveSnapshot() };
    return { name: `${stem}-${this.step}.gyre.json`, bytes: new TextEncoder().encode(this.scene.toJson()) };
  }

  close(): void {
    this.scene.dispose();
  }
}
