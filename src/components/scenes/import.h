#pragma once
// Reads imported files without preparing the scene.

namespace etendue {

class Component;

/// Reads the files of all Imports in a tree of components, also of Imports within these files. The objects of a file become the
/// objects of its Import, not prepared. Throws the same errors as preparation.
void read_imports(const Component& root);

}  // namespace etendue
