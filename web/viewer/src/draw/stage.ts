// The picture: renderer, lights, shadows, sky and fog. Knows nothing of bodies but how large the scene is.
import {
  Color,
  DirectionalLight,
  Fog,
  HemisphereLight,
  PCFShadowMap,
  PerspectiveCamera,
  Scene,
  SRGBColorSpace,
  Vector3,
  WebGLRenderer,
} from 'three';
import type { Quality, Theme } from '../state/preferences';
import type { GroundColors } from './body_material';
import { themes, type ThemeColors } from './palette';

const SUN = new Vector3(0.45, 1, 0.62).normalize();
const SHADOW_SIZE: Record<Quality, number> = { high: 2048, low: 1024 };

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(45, 1, 0.05, 5000);
  readonly renderer: WebGLRenderer;
  readonly ground: GroundColors = {
    ground: { value: new Color() },
    minor: { value: new Color() },
    major: { value: new Color() },
    cell: { value: 1 },
  };
  colors: ThemeColors = themes.dark;
  private readonly sun = new DirectionalLight('#fff4e3');
  private readonly hemisphere = new HemisphereLight();
  private readonly fog = new Fog('#000', 10, 100);
  private reach = 10;
  private lift = 0;

  constructor(private readonly holder: HTMLElement) {
    this.renderer = new WebGLRenderer({ antialias: true, powerPreference: 'high-performance', preserveDrawingBuffer: false });
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.domElement.className = 'picture';
    this.renderer.domElement.tabIndex = 0;
    this.renderer.domElement.setAttribute('aria-label', 'The scene in 3D');
    holder.append(this.renderer.domElement);
    this.sun.castShadow = true;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.02;
    this.scene.add(this.sun, this.sun.target, this.hemisphere);
    this.scene.fog = this.fog;
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resize();
  }

  setTheme(theme: Theme): void {
    const colors = themes[theme];
    this.colors = colors;
    this.scene.background = colors.horizon;
    this.fog.color = colors.horizon;
    this.hemisphere.color = colors.hemisphereSky;
    this.hemisphere.groundColor = colors.hemisphereGround;
    this.hemisphere.intensity = colors.ambient;
    this.sun.intensity = colors.sun;
    this.ground.ground.value = colors.ground;
    this.ground.minor.value = colors.gridMinor;
    this.ground.major.value = colors.gridMajor;
  }

  setQuality(quality: Quality): void {
    const size = SHADOW_SIZE[quality];
    this.renderer.setPixelRatio(quality === 'high' ? Math.min(devicePixelRatio, 2) : 1);
    if (this.sun.shadow.mapSize.x !== size) {
      this.sun.shadow.mapSize.set(size, size);
      this.sun.shadow.map?.dispose();
      this.sun.shadow.map = null;
    }
    this.resize();
  }

  // Lights, fog and grid for a scene of this radius (m).
  setScale(radius: number): void {
    this.reach = radius;
    this.fog.near = 4 * radius;
    this.fog.far = 16 * radius;
    this.camera.near = Math.max(radius / 400, 0.005);
    this.camera.far = 80 * radius + 200;
    this.camera.updateProjectionMatrix();
    this.ground.cell.value = 10 ** Math.round(Math.log10(Math.max(radius, 0.05) / 4));
    const shadow = this.sun.shadow.camera;
    const half = 1.25 * radius + 0.2;
    shadow.left = shadow.bottom = -half;
    shadow.right = shadow.top = half;
    shadow.near = 0.1 * radius;
    shadow.far = 8 * radius;
    shadow.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.0025 * radius;
    this.sun.shadow.radius = 2;
  }

  // Shadows are drawn around this place. Moved in whole texels, or their edges would crawl.
  lightAround(place: Vector3): void {
    const texel = (2.5 * this.reach) / this.sun.shadow.mapSize.x;
    const snap = (value: number): number => Math.round(value / texel) * texel;
    this.sun.target.position.set(snap(place.x), snap(place.y), snap(place.z));
    this.sun.position.copy(this.sun.target.position).addScaledVector(SUN, 4 * this.reach);
  }

  resize(): void {
    const width = Math.max(this.holder.clientWidth, 1);
    const height = Math.max(this.holder.clientHeight, 1);
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    // A tall screen sees as much to the sides as a square one does.
    this.camera.fov = width < height ? 2 * Math.atan(Math.tan(Math.PI / 8) * Math.min(height / width, 1.6)) * (180 / Math.PI) : 45;
    // A sheet covers the lower part of a phone's screen: the scene moves up to what is left.
    if (this.lift > 0) this.camera.setViewOffset(width, height, 0, this.lift * height, width, height);
    else this.camera.clearViewOffset();
    this.camera.updateProjectionMatrix();
  }

  // By which part of its height the picture is moved up.
  setLift(part: number): void {
    this.lift = part;
    this.resize();
  }

  render(): void {
    this.renderer.render(this.scene, this.camera);
  }
}
