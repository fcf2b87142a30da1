// Dependencies between the nodes of a recipe.
import type { Graph } from '../core/protocol';

/** Returns a node and all nodes that depend on it. */
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

/** Whether the material depends on a node. */
export function isUsed(graph: Graph, name: string): boolean {
  const all = reachable(graph, name);
  return Object.values(graph.material).some(({ node }) => node !== null && all.has(node));
}

/** Serializes nodes and edges without values, which determine the layout. */
export function topology(graph: Graph): string {
  const edges = graph.nodes.map((node) => [node.name, node.kind, node.inputs.map((input) => [input.label, input.node])]);
  return JSON.stringify([edges, Object.entries(graph.material).map(([map, input]) => [map, input.node])]);
}
