// A scene of side x layers x side boxes over a plane, as text.
export function manyBoxes(side, layers) {
  const bodies = [{ name: 'ground', type: 'static', shapes: [{ type: 'plane' }] }];
  for (let y = 0; y < layers; y++) {
    for (let x = 0; x < side; x++) {
      for (let z = 0; z < side; z++) {
        bodies.push({ name: `${x} ${y} ${z}`, position: [1.4 * (x - side / 2), 0.5 + 1.1 * y, 1.4 * (z - side / 2)], shapes: [{ type: 'box', half_extents: [0.5, 0.5, 0.5] }] });
      }
    }
  }
  return JSON.stringify({ gyre_scene: 1, name: `${side * side * layers} boxes`, bodies });
}
