// Members that all mutations share.

#include "etendue/transport/mutation.h"

namespace etendue {

void Mutation::describe(Description<Mutation>& d) {
  d.summary("A way in which PathSpaceMetropolis changes a path of light into another.")
      .member<&Mutation::share>("share", "1", "how often it is proposed, in proportion to the others", more_than(0),
                                soft(0.1, 10), logarithmic);
}
static const Register<Mutation> registered;

}  // namespace etendue
