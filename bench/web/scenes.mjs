// The scenes that every engine gets: unit boxes of 1 kg on a fixed ground, metres, kilograms, seconds, +y up; friction 0.5, no restitution, no
// damping, no sleep. `fixed` and `boxes` are lists of { half, place, turn }, turn a quaternion x y z w.

export const settings = { gravity: -9.81, friction: 0.5, step: 1 / 60, steps: 300 };

const unit = [0.5, 0.5, 0.5];
const upright = [0, 0, 0, 1];
const ground = { half: [100, 1, 100], place: [0, -1, 0], turn: upright };

/** A wall: rows of 30, 29, ... 1 boxes, 5 cm apart in a row; 465 boxes. */
function wall() {
  const boxes = [];
  for (let row = 0; row < 30; ++row) {
    const count = 30 - row;
    for (let i = 0; i < count; ++i) boxes.push({ half: unit, place: [(i - (count - 1) / 2) * 1.05, 0.5 + row, 0], turn: upright });
  }
  return { fixed: [ground], boxes };
}

/** Numbers in [-0.5, 0.5) that are the same for every engine: a multiplicative hash of box and part. */
function scatter(box, part) {
  let bits = Math.imul(box * 4 + part + 1, 0x9e3779b1) >>> 0;
  bits = Math.imul(bits ^ (bits >>> 15), 0x85ebca6b) >>> 0;
  return ((bits ^ (bits >>> 13)) >>> 0) / 2 ** 32 - 0.5;
}

/** A thousand boxes, turned anyhow, in layers of 7 by 7 above a pit 13 m wide. */
function pile() {
  const boxes = [];
  for (let i = 0; i < 1000; ++i) {
    const turn = [scatter(i, 0), scatter(i, 1), scatter(i, 2), scatter(i, 3) + 0.6];
    const size = Math.hypot(...turn);
    boxes.push({
      half: unit,
      place: [((i % 7) - 3) * 1.8, 1 + Math.floor(i / 49) * 1.8, ((Math.floor(i / 7) % 7) - 3) * 1.8],
      turn: turn.map((part) => part / size),
    });
  }
  const side = (half, place) => ({ half, place, turn: upright });
  return {
    fixed: [ground, side([0.5, 20, 7.5], [-7, 20, 0]), side([0.5, 20, 7.5], [7, 20, 0]), side([6.5, 20, 0.5], [0, 20, -7]), side([6.5, 20, 0.5], [0, 20, 7])],
    boxes,
  };
}

export const scenes = { wall, pile };
