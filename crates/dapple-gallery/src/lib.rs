//! The figures of the papers, one file each, and the page that shows them.
