// The visitor's hand: a kinematic body without shape where the pointer is, tied to the grabbed body by a spring. A vertex of a rope,
// cloth or solid is attached to it instead, and the hand then moves to the pointer at a pace that does not tear. It is made of public
// calls only, so it is simulated, recorded and replayed like everything else.
import { BodyType, JointKind, type BodyId, type JointId, type SoftId, type World } from 'gyre-physics';
import type { Vec3 } from '../protocol';

const FREQUENCY = 4; // Hz: follows within a quarter of a second, and a body hangs g / (2 pi f)^2 = 1.6 cm low
const DAMPING_RATIO = 1;
const PACE = 12; // 1/s: with a vertex, the hand closes this part of its distance to the pointer
const FASTEST = 12; // m/s, with a vertex

export interface HandState {
  anchor: BodyId;
  body: BodyId; // 0: a vertex of `soft` is held
  joint: JointId;
  soft: SoftId;
  vertex: number;
  goal: Vec3; // where the pointer is, in the world
}

// The same hand in a world whose ids are `by` larger.
export function moved(hand: HandState | null, by: number): HandState | null {
  const there = (id: number): number => (id === 0 ? 0 : id + by);
  return hand && { ...hand, anchor: there(hand.anchor), body: there(hand.body), joint: there(hand.joint), soft: there(hand.soft) };
}

export class Hand {
  state: HandState | null = null;

  // `at` in the world.
  grab(world: World, body: BodyId, at: Vec3): void {
    this.release(world);
    const { mass } = world.massProperties(body);
    if (!(mass > 0)) return;
    const pulse = 2 * Math.PI * FREQUENCY;
    const anchor = world.addBody({ type: BodyType.kinematic, pose: { position: at } });
    const joint = world.addJoint({
      kind: JointKind.distance,
      a: anchor,
      b: body,
      anchor: at,
      anchorB: at,
      length: 0,
      stiffness: mass * pulse * pulse,
      damping: 2 * DAMPING_RATIO * mass * pulse,
      collideConnected: true,
    });
    this.state = { anchor, body, joint, soft: 0, vertex: -1, goal: at };
    world.setAwake(body, true);
  }

  grabVertex(world: World, soft: SoftId, vertex: number): void {
    this.release(world);
    const { x, y, z } = world.vertices(soft);
    const at: Vec3 = [x[vertex]!, y[vertex]!, z[vertex]!];
    const anchor = world.addBody({ type: BodyType.kinematic, pose: { position: at } });
    world.attach(soft, vertex, anchor);
    this.state = { anchor, body: 0, joint: 0, soft, vertex, goal: at };
  }

  // Before each step of so many seconds.
  move(world: World, seconds: number): void {
    if (!this.state?.soft) return;
    const { anchor, goal } = this.state;
    const from = world.pose(anchor).position;
    const way = goal.map((value, i) => value - from[i]!);
    const length = Math.hypot(...way);
    const part = length === 0 ? 0 : Math.min(1 - Math.exp(-PACE * seconds), (FASTEST * seconds) / length);
    world.moveKinematic(anchor, { position: from.map((value, i) => value + part * way[i]!) }, seconds);
  }

  pull(world: World, to: Vec3): void {
    if (!this.state) return;
    this.state = { ...this.state, goal: to };
    if (!world.bodyExists(this.state.body)) return;
    world.setPose(this.state.anchor, { position: to });
    world.setAwake(this.state.body, true);
  }

  moveWorld(by: number): void {
    this.state = moved(this.state, by);
  }

  release(world: World): void {
    if (!this.state) return;
    if (world.bodyExists(this.state.anchor)) world.removeBody(this.state.anchor); // the joint goes with it, and a vertex is free
    this.state = null;
  }
}
