// What all importers have in common: they have no members of their own.

#include "etendue/importer.h"

namespace etendue {

void Importer::describe(Description<Importer>& d) { d.summary("Reads a file of another program into components."); }

static const Register<Importer> registered;

}  // namespace etendue
