#include "formats/permissions.h"

namespace etendue {

namespace {

ImportOptions& permissions() {
  static ImportOptions options;
  return options;
}

}  // namespace

const ImportOptions& import_permissions() { return permissions(); }
void set_import_permissions(ImportOptions options) { permissions() = std::move(options); }

}  // namespace etendue
