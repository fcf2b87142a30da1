// What depends on what in a recipe, and where its nodes lie in a drawing.
import dagre from '@dagrejs/dagre';
import type { Graph } from '../core/protocol';

/** The node and all nodes that are made of it. */
export function reachable(graph: Graph, from: string): Set<string> {
  const found = new Set([from]);
  const waiting = [from];
  for (let next = waiting.pop(); next !== undefined; next = waiting.pop()) {
    for (const node of graph.nodes) {
      if (found.has(node.name) || !node.inputs.some((input) => input.node === next)) continue;
      found.add(node.name);
      waiting.push(node.name);
    }
  }
  return found;
}

/** The size of a node in the drawing, and the gaps between nodes. */
export const NODE = { width: 150, height: 50, row: 11 };

/** How high a node with so many inputs is. */
export function heightOf(inputs: number): number {
  return Math.max(NODE.height, 8 + inputs * NODE.row);
}

/** The name of the node that stands for the material. */
export const MATERIAL = '#material';

/** Where nodes lie, from left to right; the same graph always lies the same. */
export function layout(graph: Graph): Map<string, { x: number; y: number }> {
  const drawing = new dagre.graphlib.Graph();
  drawing.setGraph({ rankdir: 'LR', nodesep: 12, ranksep: 40, marginx: 8, marginy: 8 });
  drawing.setDefaultEdgeLabel(() => ({}));
  for (const node of graph.nodes) drawing.setNode(node.name, { width: NODE.width, height: heightOf(node.inputs.length) });
  const maps = Object.entries(graph.material);
  drawing.setNode(MATERIAL, { width: NODE.width, height: heightOf(maps.length) });
  for (const node of graph.nodes) {
    for (const input of node.inputs) if (input.node !== null) drawing.setEdge(input.node, node.name);
  }
  for (const [, input] of maps) if (input.node !== null) drawing.setEdge(input.node, MATERIAL);
  dagre.layout(drawing);
  return new Map(
    drawing.nodes().map((name) => {
      const { x, y, width, height } = drawing.node(name);
      return [name, { x: x - width / 2, y: y - height / 2 }];
    }),
  );
}

/** Nodes and edges, without values: what the drawing depends on. */
export function topology(graph: Graph): string {
  const edges = graph.nodes.map((node) => [node.name, node.kind, node.inputs.map((input) => [input.label, input.node])]);
  return JSON.stringify([edges, Object.entries(graph.material).map(([map, input]) => [map, input.node])]);
}
