# Writes OUT with the commit that is being built, and only when it differs: so that nothing else is rebuilt for it.
execute_process(COMMAND git -C "${SOURCE}" describe --always --dirty=-modified --exclude=* --abbrev=12
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "")
endif()
set(text "#include \"run/build_info.h\"
namespace penumbra::run::build_info {
const char version[] = \"${VERSION}\", commit[] = \"${commit}\", build_type[] = \"${TYPE}\",
           compiler[] = \"${COMPILER}\", flags[] = \"${FLAGS}\";
}
")
set(before "")
if(EXISTS "${OUT}")
  file(READ "${OUT}" before)
endif()
if(NOT text STREQUAL before)
  file(WRITE "${OUT}" "${text}")
endif()
