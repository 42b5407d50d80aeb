# cmake -DOUT=file.cpp -DASSETS="a;b" -P embed.cmake: writes the files as byte arrays with a table of their names.
set(arrays "")
set(table "")
set(index 0)
foreach(asset ${ASSETS})
  get_filename_component(name "${asset}" NAME)
  file(READ "${asset}" hex HEX)
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${hex}")
  string(APPEND arrays "const char asset_${index}[] = {${bytes} 0};\n")
  string(APPEND table "    {\"${name}\", {asset_${index}, sizeof asset_${index} - 1}},\n")
  math(EXPR index "${index} + 1")
endforeach()
file(WRITE "${OUT}.new" "// Written by embed.cmake from harness/report/assets.
#include \"report/assets.h\"

namespace penumbra {
namespace {
${arrays}}  // namespace

std::span<const Asset> report_assets() {
  static const Asset table[] = {
${table}  };
  return table;
}
}  // namespace penumbra
")
file(RENAME "${OUT}.new" "${OUT}")
