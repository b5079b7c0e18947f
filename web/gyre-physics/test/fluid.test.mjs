// Gases and liquids by the package: fields, velocities, particles and surfaces come as arrays.
import assert from 'node:assert/strict';
import test from 'node:test';

import { engine, gyre } from './kit.mjs';

const { FluidBoundary, FluidField, FluidKind } = gyre;
const api = await engine(process.env.GYRE_WEB_BUILD ?? 'simd');
const second = 1 / 60;

test('warm smoke rises', () => {
  const world = api.createWorld();
  const gas = world.addGas({ lower: [-1, 0, -1], upper: [1, 2, 1], cells: [12, 12, 12], emitters: { position: [0, 0.3, 0], radius: 0.3, temperature: 400 } });
  for (let i = 0; i < 30; ++i) world.step(second);
  assert.deepEqual([...world.fluids()], [gas]);
  assert.equal(world.fluidInfo(gas).kind, FluidKind.gas);
  assert.ok(world.probe(gas, [0, 0.8, 0]).velocity[1] > 0.2);
  const points = [[0, 0.8, 0], [0.9, 1.9, 0.9]];
  const velocities = world.sampleVelocity(gas, points);
  assert.ok(velocities instanceof Float32Array && velocities.length === 6);
  points.forEach((point, i) => assert.deepEqual([...velocities.slice(3 * i, 3 * i + 3)], [...world.probe(gas, point).velocity]));
  const smoke = world.fluidField(gas, FluidField.smoke);
  assert.equal(smoke.length, 12 ** 3);
  assert.ok(Math.max(...smoke) > 0.5);
});

test('a dam has a surface and particles', () => {
  const world = api.createWorld();
  const liquid = world.addLiquid({ lower: [0, 0, 0], upper: [1, 1, 0.5], cellSize: 0.1, fill: { lower: [0, 0, 0], upper: [0.4, 0.6, 0.5] }, sides: Array(6).fill(FluidBoundary.closed) });
  for (let i = 0; i < 20; ++i) world.step(second);
  const { positions, velocities } = world.liquidParticles(liquid);
  assert.equal(positions.length, 3 * world.fluidInfo(liquid).particles);
  assert.equal(velocities.length, positions.length);
  assert.ok(Math.max(...positions.filter((_, i) => i % 3 === 0)) > 0.5, 'it flows on');
  for (let again = 0; again < 2; ++again) {
    const { vertices, indices } = world.liquidSurface(liquid);
    assert.ok(indices.length > 100 && indices.length % 3 === 0);
    assert.ok(Math.max(...indices) < vertices.length / 3);
    assert.ok(Math.max(...vertices) <= 1.05 && Math.min(...vertices) >= -0.05);
  }
});
