// What hands on the page need of it: the viewer is such a place.
import type { Bodies } from '../draw/bodies';
import type { CameraRig } from '../draw/camera_rig';
import type { Fluids } from '../draw/fluids';
import type { Picker } from '../draw/picker';
import type { Softs } from '../draw/softs';
import type { Stage } from '../draw/stage';
import type { Playback } from '../playback/playback';

export interface Surroundings {
  readonly playback: Playback;
  readonly stage: Stage;
  readonly bodies: Bodies;
  readonly softs: Softs;
  readonly fluids: Fluids;
  readonly picker: Picker;
  readonly rig: CameraRig;
  readonly radius: number; // m, of a ball around the scene
  readonly pointer: { readonly place: { x: number; y: number } }; // where the pointer was last
}
