// Mesh files through Assimp: OBJ, PLY (also .ply.gz), STL, OFF, MD2, 3DS, glTF.
#pragma once
#include <filesystem>

#include "scene/mesh.h"

namespace penumbra {

// One mesh with all of the file's submeshes, node transforms applied. Not cleaned. `frame`: keyframe of
// formats that have them (MD2), else 0. Throws InputError (missing file, unreadable content, unknown
// extension: known ones listed).
Mesh load_mesh(const std::filesystem::path& path, int frame = 0);

}  // namespace penumbra
