//! Volumes: the filters along three axes.
