// Gases and liquids on the screen: the frame of each box, and in it smoke as a volume, a flat gas as a picture, a liquid as its surface.
import {
  BoxGeometry, type Camera, Color, Data3DTexture, EdgesGeometry, Group, LinearFilter, LineBasicMaterial, LineSegments, RGBAFormat, UnsignedByteType, Vector3,
} from 'three';
import type { FluidDescription, FluidState, Frame, Structure } from '../protocol';
import type { Quality } from '../state/preferences';
import { FluidSlice } from './fluid_slice';
import { Liquid } from './liquid';
import type { ThemeColors } from './palette';
import { Smoke } from './smoke';

const SMOKE = '#e2e0da';
const WATER = '#3e86b0';

interface Item {
  fluid: FluidDescription;
  frame: LineSegments<EdgesGeometry, LineBasicMaterial>;
  voxels: Data3DTexture | null; // of a gas
  smoke: Smoke | null;
  slice: FluidSlice | null;
  liquid: Liquid | null;
}

export class Fluids {
  readonly group = new Group();
  private items: Item[] = [];
  private shown: Frame | null = null;
  private speeds = false;
  private surfaces = true;

  constructor(
    private quality: Quality,
    private theme: ThemeColors,
  ) {}

  clear(): void {
    for (const { frame, voxels, smoke, slice, liquid } of this.items) {
      frame.removeFromParent();
      frame.geometry.dispose();
      frame.material.dispose();
      voxels?.dispose();
      smoke?.dispose();
      slice?.dispose();
      liquid?.dispose();
    }
    this.items = [];
    this.shown = null;
  }

  restructure({ fluids }: Structure): void {
    const same = fluids.length === this.items.length && fluids.every(({ key }, i) => key === this.items[i]!.fluid.key);
    this.shown = null;
    if (same) return;
    this.clear();
    this.items = fluids.map((fluid) => this.make(fluid));
    for (const { frame, smoke, slice, liquid } of this.items) {
      this.group.add(frame);
      for (const part of [smoke, slice, liquid]) if (part) this.group.add(part.mesh);
    }
    this.obey();
  }

  private make(fluid: FluidDescription): Item {
    const { box, cells, flat, extinction } = fluid;
    const low = new Vector3(...box.low);
    const size = new Vector3(...box.high).sub(low);
    const solid = new BoxGeometry(size.x, size.y, size.z);
    const frame = new LineSegments(new EdgesGeometry(solid), new LineBasicMaterial({ transparent: true, opacity: 0.3 }));
    solid.dispose();
    frame.position.copy(low).addScaledVector(size, 0.5);
    frame.raycast = () => {};
    if (fluid.kind === 'liquid') {
      const liquid = new Liquid(new Color(fluid.color ?? WATER), this.theme.hemisphereSky);
      return { fluid, frame, voxels: null, smoke: null, slice: null, liquid };
    }
    const color = new Color(fluid.color ?? SMOKE);
    const voxels = new Data3DTexture(new Uint8Array(4 * cells[0] * cells[1] * cells[2]), ...cells);
    voxels.format = RGBAFormat;
    voxels.type = UnsignedByteType;
    voxels.minFilter = voxels.magFilter = LinearFilter;
    voxels.needsUpdate = true;
    const smoke = flat === null && fluid.smoky ? new Smoke(box, voxels, color, extinction, this.quality) : null;
    const slice = new FluidSlice(box, flat ?? (size.x >= size.z ? 2 : 0), voxels, color);
    return { fluid, frame, voxels, smoke, slice, liquid: null };
  }

  setQuality(quality: Quality): void {
    this.quality = quality;
    for (const { smoke } of this.items) smoke?.setQuality(quality);
  }

  setTheme(theme: ThemeColors): void {
    this.theme = theme;
    this.obey();
  }

  // `speeds`: gases as pictures of their speed; `surfaces`: of liquids.
  setLook(speeds: boolean, surfaces: boolean): void {
    this.speeds = speeds;
    this.surfaces = surfaces;
    this.obey();
  }

  private obey(): void {
    const { link, sun, ambient, hemisphereSky } = this.theme;
    for (const { fluid, frame, smoke, slice, liquid } of this.items) {
      frame.material.color = link;
      smoke?.setLight(0.26 * sun, 0.2 * ambient);
      liquid?.setSky(hemisphereSky);
      if (liquid) liquid.mesh.visible = this.surfaces;
      if (!slice) continue;
      slice.mesh.visible = this.speeds || fluid.flat !== null;
      slice.showSpeed(this.speeds || !fluid.smoky);
    }
  }

  show(frame: Frame): void {
    if (frame === this.shown) return;
    this.shown = frame;
    this.items.forEach((item, i) => {
      const state = frame.fluids[i];
      if (state) fill(item, state);
    });
  }

  // Before each picture.
  face(camera: Camera): void {
    for (const { smoke } of this.items) smoke?.face(camera);
  }

  get known(): FluidDescription[] {
    return this.items.map(({ fluid }) => fluid);
  }
}

function fill({ voxels, liquid }: Item, state: FluidState): void {
  if (voxels && state.voxels.length > 0) {
    voxels.image.data = state.voxels;
    voxels.needsUpdate = true;
  }
  liquid?.show(state);
}
