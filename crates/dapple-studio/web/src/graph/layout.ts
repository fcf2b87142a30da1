// Layout of the graph of nodes.
import dagre from '@dagrejs/dagre';
import type { Graph } from '../core/protocol';

/** The size of a node in the graph, and the height of an input row. */
export const NODE = { width: 176, height: 54, row: 11 };

/** The height of a node with this number of inputs. */
export function heightOf(inputs: number): number {
  return Math.max(NODE.height, 8 + inputs * NODE.row);
}

/** The name of the node that represents the material. */
export const MATERIAL = '#material';

/** Positions of nodes by name. */
export type Spots = Map<string, { x: number; y: number }>;

/** Positions of the nodes, laid out from left to right. Equal graphs have equal layouts. */
export function layout(graph: Graph): Spots {
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

/** Adds nodes without a position to a layout made by hand: to the right of their inputs, and below all others. */
export function fill(graph: Graph, hand: Spots, dropped: { x: number; y: number } | null): Spots {
  const spots = new Map(hand);
  const names = [...graph.order, MATERIAL].filter((name) => !hand.has(name));
  for (const name of names) {
    const inputs = graph.nodes.find((node) => node.name === name)?.inputs ?? Object.values(graph.material);
    const left = inputs.flatMap(({ node }) => spots.get(node ?? '')?.x ?? []);
    const bottom = Math.max(...[...spots.values()].map(({ y }) => y));
    spots.set(name, dropped ?? { x: left.length > 0 ? Math.max(...left) + NODE.width + 40 : 0, y: bottom + NODE.height + 24 });
  }
  return spots;
}
