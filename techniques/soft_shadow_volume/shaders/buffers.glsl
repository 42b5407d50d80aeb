// Buffer references to the room's own structs.
#include "gpu/shaders/common.glsl"

layout(buffer_reference) buffer SilhouetteArray;
layout(buffer_reference) buffer WedgeArray;
layout(buffer_reference) buffer ExtractionRef;
#include "techniques/soft_shadow_volume/shaders/shared.h"
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer SilhouetteArray { Silhouette at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer WedgeArray { Wedge at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ExtractionRef { Extraction at; uint near_cap[]; };
