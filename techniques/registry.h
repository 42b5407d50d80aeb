// The list of techniques. app alone includes it.
#pragma once
#include "technique/technique.h"

namespace penumbra {
Registry all_techniques();
}
