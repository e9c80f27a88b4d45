# Makes C++ of the page: one HTML document with its styles and scripts in it.
# Usage: cmake -DHTML=... -DCSS=... -DSCRIPTS=a.js,b.js,... -DOUTPUT=... -P embed_page.cmake

# The base64 text of a SHA-256, as a Content-Security-Policy wants it.
function(sha256_base64 text result)
  set(alphabet ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/)
  string(SHA256 hex "${text}")
  set(base64 "")
  foreach(start RANGE 0 60 6)
    string(SUBSTRING "${hex}00" ${start} 6 three_bytes)  # 32 bytes, and a zero to fill up
    foreach(shift 18 12 6 0)
      math(EXPR index "(0x${three_bytes} >> ${shift}) & 63")
      string(SUBSTRING "${alphabet}" ${index} 1 letter)
      string(APPEND base64 "${letter}")
    endforeach()
  endforeach()
  string(SUBSTRING "${base64}" 0 43 base64)
  set(${result} "${base64}=" PARENT_SCOPE)
endfunction()

file(READ "${HTML}" page)
file(READ "${CSS}" style)
set(script "")
string(REPLACE "," ";" scripts "${SCRIPTS}")
foreach(name IN LISTS scripts)
  file(READ "${name}" part)
  string(APPEND script "${part}")
endforeach()

sha256_base64("${style}" style_hash)
sha256_base64("${script}" script_hash)
string(REPLACE "/*STYLE*/" "${style}" page "${page}")
string(REPLACE "/*SCRIPT*/" "${script}" page "${page}")

set(policy "default-src 'self'; script-src 'sha256-${script_hash}'; \
style-src 'sha256-${style_hash}'; img-src 'self' data:; base-uri 'none'; form-action 'none'; \
frame-ancestors 'none'")

file(WRITE "${OUTPUT}.new" "// Made of apps/view/page/ by embed_page.cmake.
#include \"apps/view/view_page.h\"

namespace loopgrid {

std::string_view ViewPage() { return R\"loopgrid(${page})loopgrid\"; }

std::string_view ViewPagePolicy() { return \"${policy}\"; }

}  // namespace loopgrid
")
file(RENAME "${OUTPUT}.new" "${OUTPUT}")
