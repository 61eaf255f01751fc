#pragma once
// The library of foreign formats: importers, exporters, imitations of other programs' models and what only they use
// (libetendue_formats.so; src/components/importers, exporters and imitations). It is loaded when a file of another program is
// read or written, a part of such a file is opened
// ("model.glb#images[3].png"), or a class of it is looked up by name. So rendering a description of our own neither waits for
// it nor is built with it.

#include <mutex>

namespace etendue {

/// Opens the library, whose static initializers enlist its classes and register its file formats. Returns false if that was
/// done before. Throws Error if there is none beside this one. Thread-safe.
bool load_format_library();

/// Guards the lists that static initializers of a library write to: the pending classes of the registry, the containers, the
/// mesh formats. It is held while a library is opened, and by all who read these lists.
std::recursive_mutex& libraries_guard();

}  // namespace etendue
