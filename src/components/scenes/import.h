#pragma once
// What other programs' files hold, for those who look at a scene that is not prepared.

namespace etendue {

class Component;

/// Reads the file of each Import in a tree, those in it included: what it holds become its objects, which are not prepared.
/// Throws as its preparation would.
void read_imports(const Component& root);

}  // namespace etendue
