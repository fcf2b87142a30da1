// Renders the lit material with WebGL: received maps become textures of a physically based material.
//
// Normals are in tangent space. Occlusion, roughness and metallic are packed as in glTF. Albedo is sRGB, all other
// maps are linear. Opacity is blended or cut off. Heights displace the surface by the relief of the recipe. An optional map
// has no effect until its image has arrived. The environment is generated: a sky that gets brighter toward the top, and
// three soft boxes.
import {
  AmbientLight, BackSide, BoxGeometry, type BufferGeometry, Color, DataTexture, DirectionalLight, DoubleSide, FrontSide,
  LinearFilter, LinearMipmapLinearFilter, Mesh, MeshBasicMaterial, MeshPhysicalMaterial, NeutralToneMapping, NoColorSpace, PerspectiveCamera, PlaneGeometry,
  PMREMGenerator, RepeatWrapping, RGBAFormat, Scene, SphereGeometry, SRGBColorSpace, type Texture, UnsignedByteType,
  Vector2, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { Picture } from '../core/pictures';
import { weld } from './weld';

/** How a material is applied to a shape. */
export interface Lay {
  shape: 'sphere' | 'plane' | 'model';
  repeat: number;
  /** Height of the largest displacement divided by the width of the tile. */
  relief: number;
  displaced: boolean;
  aspect: number;
  /** Whether the green channel of normals points down. */
  flipped: boolean;
}

/** Numbers of the material that belong to its optional maps. */
export interface Numbers {
  /** The opacity below which pixels are transparent, or null to blend. */
  cutoff: number | null;
  /** The factor of the emission. */
  strength: number;
  coatRoughness: number;
}

/** The maps that every material has. */
export const LIT = ['albedo', 'normal', 'orm', 'height'] as const;

/** The textures of the material that show each map. */
const SLOTS = new Map([
  ['albedo', ['map']],
  ['normal', ['normalMap']],
  ['orm', ['aoMap', 'roughnessMap', 'metalnessMap']],
  ['height', ['displacementMap']],
  ['opacity', ['alphaMap']],
  ['emission', ['emissiveMap']],
  ['specular', ['specularIntensityMap']],
  ['clearcoat', ['clearcoatMap']],
] as const);

/** A scene in a canvas, redrawn only after changes. */
export class LitScene {
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(35, 1, 0.01, 100);
  readonly #controls: OrbitControls;
  readonly #material = new MeshPhysicalMaterial({ roughness: 1, metalness: 1, envMapIntensity: 0.75 });
  readonly #mesh = new Mesh<BufferGeometry, MeshPhysicalMaterial>(new SphereGeometry(1, 64, 32), this.#material);
  readonly #light = new DirectionalLight(0xfff4e2, 1.9);
  readonly #textures = new Map<string, DataTexture>();
  /** The mipmap level of the height map whose texels are as far apart as the vertices. */
  readonly #level = { value: 0 };
  #model: BufferGeometry | null = null;
  #shape = '';
  #waiting = 0;
  /** The number of drawn frames. */
  frames = 0;

  constructor(canvas: HTMLCanvasElement) {
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, powerPreference: 'high-performance' });
    this.#renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.#renderer.toneMapping = NeutralToneMapping;
    this.#scene.environment = surroundings(this.#renderer);
    this.#light.position.set(-2.2, 2.6, 2.4);
    this.#material.onBeforeCompile = (shader) => {
      shader.uniforms['displacementLevel'] = this.#level;
      shader.vertexShader = shader.vertexShader.replace('#include <displacementmap_vertex>', DISPLACEMENT).replace('#include <displacementmap_pars_vertex>', `#include <displacementmap_pars_vertex>
uniform float displacementLevel;
attribute vec3 weldedNormal;
attribute vec2 weldedUv;`);
    };
    this.#scene.add(this.#mesh, this.#light, new AmbientLight(0xffffff, 0.05));
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.enableDamping = false;
    this.#controls.enablePan = false;
    this.#controls.minDistance = 1.25;
    this.#controls.maxDistance = 12;
    this.#controls.addEventListener('change', () => this.later());
    this.#camera.position.set(0, 0.6, 3.9);
    this.#controls.update();
  }

  /** Updates the texture of a map. */
  take(name: string, picture: Picture | undefined): void {
    const whole = picture && joined(picture);
    if (!picture || !whole) return;
    // The material reads the strength of reflections from alpha.
    const pixels = name === 'specular' ? withAlpha(whole) : whole;
    const [w, h] = picture.size;
    let texture = this.#textures.get(name);
    if (texture && texture.image.width === w && texture.image.height === h) texture.image.data = pixels;
    else {
      texture?.dispose();
      texture = textureOf(pixels, w, h, name === 'albedo' || name === 'emission');
      this.#textures.set(name, texture);
      this.#wear(name, texture);
    }
    texture.needsUpdate = true;
    this.later();
  }

  /** Applies the material to a shape. */
  lay(lay: Lay): void {
    const geometry = `${lay.shape} ${lay.displaced} ${lay.aspect}`;
    if (geometry !== this.#shape) this.#build(lay);
    this.#shape = geometry;
    const around = lay.shape === 'sphere' ? 2 : 1;
    for (const texture of this.#textures.values()) texture.repeat.set(lay.repeat * around, lay.repeat / (lay.shape === 'plane' ? 1 : lay.aspect));
    const [columns] = segments(lay);
    const texels = (this.#textures.get('height')?.image.width ?? 1) * lay.repeat * around;
    this.#level.value = Math.max(0, Math.log2(texels / columns));
    const width = lay.shape === 'plane' ? 2 / lay.repeat : Math.PI / lay.repeat;
    this.#material.displacementScale = lay.displaced ? lay.relief * width : 0;
    this.#material.displacementBias = -this.#material.displacementScale / 2;
    this.#material.normalScale = new Vector2(1, lay.flipped ? -1 : 1);
    this.later();
  }

  /** Loads a model from a GLB or OBJ file of the user. */
  async load(file: File): Promise<void> {
    const found: BufferGeometry[] = [];
    const collect = (object: unknown) => object instanceof Mesh && found.push((object as Mesh).geometry);
    if (/\.obj$/i.test(file.name)) {
      const { OBJLoader } = await import('three/addons/loaders/OBJLoader.js');
      new OBJLoader().parse(await file.text()).traverse(collect);
    } else {
      const { GLTFLoader } = await import('three/addons/loaders/GLTFLoader.js');
      // Materials of the file are not shown. Loading their textures would violate the content security policy.
      const plain = { name: 'plain', loadMaterial: () => Promise.resolve(this.#material) };
      (await new GLTFLoader().register(() => plain).parseAsync(await file.arrayBuffer(), '')).scene.traverse(collect);
    }
    const largest = found.toSorted((a, b) => count(b) - count(a))[0];
    if (!largest) throw new Error('there is no mesh in the file');
    if (!largest.getAttribute('uv')) throw new Error('the mesh has no texture coordinates');
    this.#model = fitted(largest.clone());
    this.#shape = '';
  }

  /** Shows the optional maps `extras` of the material, and removes all others. */
  show(extras: string[], { cutoff, strength, coatRoughness }: Numbers): void {
    for (const [name, slots] of SLOTS) {
      if (extras.includes(name) || LIT.some((one) => one === name)) continue;
      this.#textures.get(name)?.dispose();
      this.#textures.delete(name);
      for (const slot of slots) this.#material[slot] = null;
    }
    const isOpen = extras.includes('opacity');
    this.#material.transparent = isOpen && cutoff === null;
    this.#material.alphaTest = isOpen ? (cutoff ?? 0) : 0;
    this.#material.side = isOpen ? DoubleSide : FrontSide;
    this.#material.emissiveIntensity = strength;
    this.#material.clearcoatRoughness = coatRoughness;
    this.#weigh();
  }

  /** Sets the factors of the optional maps: 0 without the map. */
  #weigh(): void {
    this.#material.emissive.set(this.#material.emissiveMap ? 0xffffff : 0x000000);
    this.#material.clearcoat = this.#material.clearcoatMap ? 1 : 0;
    this.#material.needsUpdate = true;
    this.later();
  }

  /** Rotates the light about the vertical axis. The angle is in turns. */
  turnLight(turn: number): void {
    const angle = turn * 2 * Math.PI;
    this.#light.position.set(Math.sin(angle) * 3.2, 2.6, Math.cos(angle) * 3.2);
    this.#scene.environmentRotation.y = angle;
    this.later();
  }

  /** Rotates the view from the keyboard. Angles are in radians. */
  orbit(x: number, y: number): void {
    const at = this.#camera.position.clone();
    const radius = at.length();
    const tilt = Math.min(3, Math.max(0.14, Math.acos(at.y / radius) + y));
    const turn = Math.atan2(at.x, at.z) + x;
    this.#camera.position.set(radius * Math.sin(tilt) * Math.sin(turn), radius * Math.cos(tilt), radius * Math.sin(tilt) * Math.cos(turn));
    this.#controls.update();
    this.later();
  }

  resize(width: number, height: number): void {
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = width / Math.max(1, height);
    this.#camera.updateProjectionMatrix();
    this.later();
  }

  /** Schedules a redraw for the next frame. */
  later(): void {
    this.#waiting ||= requestAnimationFrame(() => {
      this.#waiting = 0;
      this.frames += 1;
      this.#renderer.render(this.#scene, this.#camera);
    });
  }

  dispose(): void {
    cancelAnimationFrame(this.#waiting);
    for (const texture of this.#textures.values()) texture.dispose();
    this.#mesh.geometry.dispose();
    this.#controls.dispose();
    this.#renderer.dispose();
  }

  #build(lay: Lay): void {
    this.#mesh.geometry.dispose();
    const [columns, rows] = segments(lay);
    if (lay.shape === 'model' && this.#model) this.#mesh.geometry = this.#model.clone();
    else if (lay.shape === 'plane') this.#mesh.geometry = new PlaneGeometry(2, 2 * lay.aspect, columns, rows);
    else this.#mesh.geometry = new SphereGeometry(1, columns, rows);
    weld(this.#mesh.geometry);
    this.#mesh.rotation.x = lay.shape === 'plane' ? -0.5 : 0;
  }

  #wear(name: string, texture: DataTexture): void {
    for (const [map, slots] of SLOTS) {
      if (map === name) for (const slot of slots) this.#material[slot] = texture;
    }
    const [other] = [...this.#textures.values()].filter((one) => one !== texture);
    if (other) texture.repeat.copy(other.repeat);
    this.#weigh();
  }
}

/** The number of segments of a shape along its width and height. */
function segments({ shape, displaced }: Lay): [number, number] {
  if (shape === 'sphere') return displaced ? [320, 160] : [128, 64];
  return displaced ? [256, 256] : [1, 1];
}

/**
 * Displaces a vertex by the height averaged over the texels between vertices, so that steep borders are not jagged.
 */
const DISPLACEMENT = `
#ifdef USE_DISPLACEMENTMAP
  vec2 place = (displacementMapTransform * vec3(weldedUv, 1.0)).xy;
  float height = textureLod(displacementMap, place, displacementLevel).x;
  transformed += weldedNormal * (height * displacementScale + displacementBias);
#endif
`;

/** The pixels of an image, top row first; the texture flips the rows. Returns null while pieces are missing. */
function joined(picture: Picture): Uint8ClampedArray<ArrayBuffer> | null {
  const [w, h] = picture.size;
  const pieces = picture.whole;
  if (pieces.reduce((sum, piece) => sum + piece.width * piece.height, 0) !== w * h) return null;
  const [only] = pieces;
  if (only && pieces.length === 1) return only.pixels;
  const all = new Uint8ClampedArray(w * h * 4);
  for (const { rect, width, height, pixels } of pieces) {
    const [x, y] = [Math.round(rect.x * w), Math.round(rect.y * h)];
    for (let row = 0; row < height; row += 1) {
      all.set(pixels.subarray(row * width * 4, (row + 1) * width * 4), ((y + row) * w + x) * 4);
    }
  }
  return all;
}

/** A copy of gray pixels with their value as alpha. */
function withAlpha(gray: Uint8ClampedArray<ArrayBuffer>): Uint8ClampedArray<ArrayBuffer> {
  const pixels = gray.slice();
  for (let i = 0; i < pixels.length; i += 4) pixels[i + 3] = pixels[i] as number;
  return pixels;
}

function textureOf(pixels: Uint8ClampedArray<ArrayBuffer>, w: number, h: number, color: boolean): DataTexture {
  const texture = new DataTexture(pixels, w, h, RGBAFormat, UnsignedByteType);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.colorSpace = color ? SRGBColorSpace : NoColorSpace;
  texture.generateMipmaps = true;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.anisotropy = 8;
  texture.flipY = true;
  return texture;
}

function surroundings(renderer: WebGLRenderer): Texture {
  const scene = new Scene();
  const room = new Mesh(new BoxGeometry(20, 20, 20), [0.35, 0.35, 1.1, 0.12, 0.3, 0.45].map((light) => new MeshBasicMaterial({ color: new Color(light, light, light * 1.04), side: BackSide })));
  scene.add(room);
  const boxes: [number, number, number, number, number][] = [[-6, 7, 5, 4, 14], [8, 3, 2, 2.5, 8], [0, 4, -9, 6, 5]];
  for (const [x, y, z, size, light] of boxes) {
    const box = new Mesh(new PlaneGeometry(size, size), new MeshBasicMaterial({ color: new Color(light, light * 0.97, light * 0.92) }));
    box.position.set(x, y, z);
    box.lookAt(0, 0, 0);
    scene.add(box);
  }
  const generator = new PMREMGenerator(renderer);
  const texture = generator.fromScene(scene, 0.03).texture;
  generator.dispose();
  return texture;
}

function count(geometry: BufferGeometry): number {
  return geometry.getAttribute('position')?.count ?? 0;
}

/** Centers a model at the origin and scales it to about the size of the sphere. */
function fitted(geometry: BufferGeometry): BufferGeometry {
  geometry.center();
  geometry.computeBoundingSphere();
  const radius = geometry.boundingSphere?.radius ?? 1;
  geometry.scale(1.15 / radius, 1.15 / radius, 1.15 / radius);
  const isSmooth = !geometry.getAttribute('normal');
  if (isSmooth) geometry.computeVertexNormals();
  weld(geometry);
  if (isSmooth) geometry.setAttribute('normal', geometry.getAttribute('weldedNormal'));
  return geometry;
}
