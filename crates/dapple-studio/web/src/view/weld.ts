// Welds vertices at the same position for displacement.
//
// A mesh file repeats a vertex at every border of a texture chart and at every hard edge, with other texture coordinates
// and another normal. Moved along their own normals by their own heights, such vertices separate, and the surface
// shows cracks.
import { BufferAttribute, type BufferGeometry, Vector3 } from 'three';

/** Positions are rounded to this fraction of a unit, for a model that is about one unit large. */
const STEPS = 1e5;

/**
 * Adds the attributes `weldedNormal`, the mean normal of all vertices at a position, and `weldedUv`, the texture
 * coordinates of the first of them.
 */
export function weld(geometry: BufferGeometry): void {
  const position = geometry.getAttribute('position');
  const normal = geometry.getAttribute('normal');
  const uv = geometry.getAttribute('uv');
  // Find the first vertex at each position, and add up the normals there.
  const firsts = new Map<string, number>();
  const first = new Uint32Array(position.count);
  const sums = Array.from({ length: position.count }, () => new Vector3());
  const one = new Vector3();
  for (let i = 0; i < position.count; i += 1) {
    const key = one.fromBufferAttribute(position, i).multiplyScalar(STEPS).round().toArray().join();
    first[i] = firsts.get(key) ?? i;
    firsts.set(key, first[i] as number);
    sums[first[i] as number]?.add(one.fromBufferAttribute(normal, i));
  }
  // Write the mean normal and the first texture coordinates to all vertices.
  const normals = new BufferAttribute(new Float32Array(position.count * 3), 3);
  const uvs = new BufferAttribute(new Float32Array(position.count * 2), 2);
  for (let i = 0; i < position.count; i += 1) {
    const from = first[i] as number;
    one.copy(sums[from] ?? one);
    // Opposite normals cancel out, for example on both sides of a sheet.
    if (one.length() < 1e-6) one.fromBufferAttribute(normal, from);
    one.normalize();
    normals.setXYZ(i, one.x, one.y, one.z);
    uvs.setXY(i, uv.getX(from), uv.getY(from));
  }
  geometry.setAttribute('weldedNormal', normals);
  geometry.setAttribute('weldedUv', uvs);
}
