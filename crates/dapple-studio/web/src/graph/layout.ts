// Layout of the graph of nodes.
import dagre from '@dagrejs/dagre';
import type { Graph } from '../core/protocol';

/** The size of a node in the graph, and the height of an input row. */
export const NODE = { width: 150, height: 50, row: 11 };

/** The height of a node with this number of inputs. */
export function heightOf(inputs: number): number {
  return Math.max(NODE.height, 8 + inputs * NODE.row);
}

/** The name of the node that represents the material. */
export const MATERIAL = '#material';

/** Positions of the nodes, laid out from left to right. Equal graphs have equal layouts. */
export function layout(graph: Graph): Map<string, { x: number; y: number }> {
  const drawing = new dagre.graphlib.Graph();
  drawing.setGraph({ rankdir: 'LR', nodesep: 12, ranksep: 40, marginx: 8, marginy: 8 });
  drawing.setDefaultEdgeLabel(() => ({}));
  for (const node of graph.nodes) drawing.setNode(node.name, { width: NODE.width, height: heightOf(node.inputs.length) });
  const maps = Object.entries(graph.material);
  drawing.setNode(MATERIAL, { width: NODE.width, height: heightOf(maps.length) });
  // An invalid recipe may name nodes that do not exist.
  const link = (from: string | null, to: string) => from !== null && drawing.hasNode(from) && drawing.setEdge(from, to);
  for (const node of graph.nodes) for (const input of node.inputs) link(input.node, node.name);
  for (const [, input] of maps) link(input.node, MATERIAL);
  dagre.layout(drawing);
  return new Map(
    drawing.nodes().map((name) => {
      const { x, y, width, height } = drawing.node(name);
      return [name, { x: x - width / 2, y: y - height / 2 }];
    }),
  );
}
