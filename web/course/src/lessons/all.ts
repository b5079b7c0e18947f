// The lessons by the name that a page gives in data-lesson.
import type { Lesson } from '../lesson';
import { friction, inertia, orientation } from './bodies';
import { boundingVolumes, continuousCollision, separatingAxes, trees } from './collision';
import { gas, liquid } from './fluids';
import { cloth, finiteElements, ropes } from './soft';
import { integrators, solvers, springs } from './stepping';

export const lessons: Record<string, Lesson> = {
  orientation,
  inertia,
  friction,
  bounding_volumes: boundingVolumes,
  trees,
  separating_axes: separatingAxes,
  continuous_collision: continuousCollision,
  integrators,
  springs,
  ropes,
  solvers,
  cloth,
  finite_elements: finiteElements,
  gas,
  liquid,
};
