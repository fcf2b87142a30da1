//! Partition-of-unity parametrics for texture synthesis: values, orientations, labels and the texture recipes.
