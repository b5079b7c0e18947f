// The visitor's hand: a kinematic body without shape where the pointer is, tied to the grabbed body by a spring. Of a rope, cloth or
// solid it holds vertices: they are attached to a light body without shape, the grip, and the spring pulls that with a bounded force. It is
// made of public calls only, so it is simulated, recorded and replayed like everything else.
import { BodyType, JointKind, SoftKind, type BodyId, type JointId, type SoftId, type World } from 'gyre-physics';
import type { Vec3 } from '../protocol';

const FREQUENCY = 4; // Hz: follows within a quarter of a second, and a body hangs g / (2 pi f)^2 = 1.6 cm low
const DAMPING_RATIO = 1;
const GRIP_MASS = 0.1; // of that of what it holds
const STRENGTH = 100; // m/s^2: with soft matter, the largest force is this times its mass

export interface HandState {
  anchor: BodyId;
  body: BodyId;
  joint: JointId;
  grip: boolean; // the body is a grip
}

// The same hand in a world whose ids are `by` larger.
export function moved(hand: HandState | null, by: number): HandState | null {
  return hand && { ...hand, anchor: hand.anchor + by, body: hand.body + by, joint: hand.joint + by };
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
    this.state = { anchor, body, joint, grip: false };
    world.setAwake(body, true);
  }

  // The vertices that are nearest to `at`, but for those that are `held` by others. `load`: kg, of what hangs on the soft matter.
  grabSoft(world: World, soft: SoftId, at: Vec3, held: ReadonlySet<number>, load: number): void {
    this.release(world);
    const info = world.softInfo(soft);
    const vertices = nearest(world, soft, at, held, handful(info.kind, info.vertices));
    if (vertices.length === 0) return;
    const { x, y, z } = world.vertices(soft);
    const places = vertices.map((i): Vec3 => [x[i]!, y[i]!, z[i]!]);
    const middle = places[0]!;
    const radius = Math.max(0.02, ...places.map((place) => distance(place, middle)));
    const all = info.mass + load;
    const mass = GRIP_MASS * all;
    const turn = 0.4 * mass * radius * radius;
    const anchor = world.addBody({ type: BodyType.kinematic, pose: { position: middle } });
    const body = world.addBody({ pose: { position: middle }, mass, inertia: [turn, turn, turn, 0, 0, 0], gravityScale: 0, canSleep: false });
    for (const vertex of vertices) world.attach(soft, vertex, body);
    // The joint takes its stiffness and damping from the mass of the grip; they are meant for all that it holds.
    const ratio = Math.sqrt(1 / GRIP_MASS);
    const drive = { frequency: FREQUENCY * ratio, dampingRatio: DAMPING_RATIO * ratio, maxForce: STRENGTH * all };
    const joint = world.addJoint({ kind: JointKind.mouse, a: anchor, b: body, anchor: middle, drive });
    this.state = { anchor, body, joint, grip: true };
  }

  pull(world: World, to: Vec3): void {
    if (!this.state || !world.bodyExists(this.state.body)) return;
    world.setPose(this.state.anchor, { position: to });
    world.setAwake(this.state.body, true);
  }

  moveWorld(by: number): void {
    this.state = moved(this.state, by);
  }

  // Joints and attachments go with the bodies.
  release(world: World): void {
    if (!this.state) return;
    const { anchor, body, grip } = this.state;
    for (const own of grip ? [anchor, body] : [anchor]) {
      if (world.bodyExists(own)) world.removeBody(own);
    }
    this.state = null;
  }
}

// How many vertices a hand holds: a rope at a point, a cloth by a pinch, a solid by a corner.
function handful(kind: SoftKind, vertices: number): number {
  const part = kind === SoftKind.rope ? 0 : kind === SoftKind.cloth ? 0.003 : 0.05;
  return Math.min(Math.max(1, Math.round(part * vertices)), 48);
}

const distance = (a: Vec3, b: Vec3): number => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

// By distance; fewer than `count` if there are not so many.
function nearest(world: World, soft: SoftId, at: Vec3, held: ReadonlySet<number>, count: number): number[] {
  const { x, y, z } = world.vertices(soft);
  const away = Float64Array.from(x, (_, i) => distance([x[i]!, y[i]!, z[i]!], at));
  const free = Array.from(away.keys()).filter((i) => !held.has(i));
  return free.sort((a, b) => away[a]! - away[b]! || a - b).slice(0, count);
}
