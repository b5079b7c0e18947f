// How the bodies of a scene look. Colours and materials come from the engine's reader of scenes, so that every picture of a scene
// agrees; which bodies are sensors is read from the file, since a world does not tell.
import type { Scene } from 'gyre-physics';
import type { Vec3 } from '../protocol';
import type { SceneJson } from './scene_source';

export interface Look {
  material: string;
  color: number | null; // 0xrrggbb; null: the page picks one
  sensor: boolean;
}

export class Looks {
  constructor(
    private readonly json: SceneJson,
    private readonly scene: Scene,
  ) {}

  // Of shape `shape` of the scene's body `body`; -1 is a body that was added later.
  shape(body: number, shape: number): Look {
    return {
      material: this.scene.materialNames[body]?.[shape] ?? '',
      color: this.scene.colors[body]?.[shape] ?? null,
      sensor: this.json.bodies?.[body]?.sensor === true,
    };
  }

  view(origin: Vec3): { eye: Vec3; target: Vec3; fieldOfView: number } | null {
    const { view } = this.scene;
    if (!view) return null;
    const here = (place: Vec3): Vec3 => [place[0] - origin[0], place[1] - origin[1], place[2] - origin[2]];
    return { eye: here(view.eye), target: here(view.target), fieldOfView: view.fieldOfView };
  }
}
