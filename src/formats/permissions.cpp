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

namespace {
bool for_rgb = false;
}

bool imports_for_rgb() { return for_rgb; }
void set_imports_for_rgb(bool on) { for_rgb = on; }

}  // namespace etendue
