// The visitor's hand: a kinematic body without shape where the pointer is, tied to the grabbed body by a spring. It is made of
// public calls only, so it is simulated, recorded and replayed like everything else.
import { BodyType, JointKind, type BodyId, type JointId, type World } from 'gyre-physics';
import type { Vec3 } from '../protocol';

const FREQUENCY = 4; // Hz: follows within a quarter of a second, and a body hangs g / (2 pi f)^2 = 1.6 cm low
const DAMPING_RATIO = 1;

export interface HandState {
  anchor: BodyId;
  body: BodyId;
  joint: JointId;
}

// The same hand in a world whose ids are `by` larger.
export function moved(hand: HandState | null, by: number): HandState | null {
  return hand && { anchor: hand.anchor + by, body: hand.body + by, joint: hand.joint + by };
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
    this.state = { anchor, body, joint };
    world.setAwake(body, true);
  }

  pull(world: World, to: Vec3): void {
    if (!this.state || !world.bodyExists(this.state.body)) return;
    world.setPose(this.state.anchor, { position: to });
    world.setAwake(this.state.body, true);
  }

  moveWorld(by: number): void {
    this.state = moved(this.state, by);
  }

  release(world: World): void {
    if (!this.state) return;
    if (world.bodyExists(this.state.anchor)) world.removeBody(this.state.anchor); // the joint goes with it
    this.state = null;
  }
}
