#pragma once
// The library of foreign formats: importers, exporters and what only they use (libetendue_formats.so, src/components/importers
// and exporters). It is loaded when a file of another program is read or written, or a class of it is looked up by name, so
// that rendering a description of our own neither waits for it nor is built with it.

namespace etendue {

/// Opens the library, whose static initializers enlist its classes. Returns false if that was done before. Throws Error if
/// there is none beside this one.
bool load_format_library();

}  // namespace etendue
