# What assembling a page needs, in CMake's script mode: `page` holds the template; styles and scripts are put into it, and it
# is written as two C++ strings, what comes before the data of a run and what comes after.

# In place of <!-- PLACE -->.
function(insert place text)
  string(FIND "${page}" "<!-- ${place} -->" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "page.html has no place for ${place}")
  endif()
  string(REPLACE "<!-- ${place} -->" "${text}" page "${page}")
  set(page "${page}" PARENT_SCOPE)
endfunction()

# The page runs these scripts and applies this style, and nothing else that may have got into it: their digests stand in
# its content security policy.
set(base64_letters ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/)
function(digest result text)
  string(SHA256 hex "${text}")
  string(APPEND hex 00)  # 12 bits, two letters, at a time
  set(letters "")
  foreach(start RANGE 0 63 3)
    string(SUBSTRING ${hex} ${start} 3 bits)
    math(EXPR first "0x${bits} >> 6")
    math(EXPR second "0x${bits} & 63")
    foreach(place ${first} ${second})
      string(SUBSTRING ${base64_letters} ${place} 1 letter)
      string(APPEND letters ${letter})
    endforeach()
  endforeach()
  string(SUBSTRING ${letters} 0 43 letters)  # of 32 bytes; the last letter is padding
  set(${result} "'sha256-${letters}='" PARENT_SCOPE)
endfunction()
set(script_digests "")

# A macro, as its digest is remembered for the policy.
macro(insert_library place path)
  file(READ ${path} script)
  if(script MATCHES "</script|<!--")
    message(FATAL_ERROR "${path} cannot stand inside of an HTML page as it is")
  endif()
  insert(${place} "<script>${script}</script>")
  digest(one "${script}")
  string(APPEND script_digests " ${one}")
endmacro()

# The style, and our scripts, paths in order; then the policy, which must come last.
macro(insert_our_own style)
  insert(STYLE "<style>${style}</style>")
  digest(style_digest "${style}")
  set(scripts "")
  foreach(path ${ARGN})
    file(READ ${path} script)
    string(APPEND scripts "<script>${script}</script>\n")
    digest(one "${script}")
    string(APPEND script_digests " ${one}")
  endforeach()
  insert(SCRIPTS "${scripts}")
  insert(POLICY "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src${script_digests}; \
style-src ${style_digest}; base-uri 'none'; form-action 'none'\">")
endmacro()

# Declared in `header`, as NAME_head and NAME_tail.
function(write_page output header name)
  string(FIND "${page}" "<!-- DATA -->" split)
  string(SUBSTRING "${page}" 0 ${split} head)
  string(SUBSTRING "${page}" ${split} -1 tail)
  string(REPLACE "<!-- DATA -->" "" tail "${tail}")
  file(WRITE ${output} "#include \"${header}\"\n\nnamespace igsp::cli {\n\n"
    "const std::string_view ${name}_head = R\"igsp(${head})igsp\";\n\n"
    "const std::string_view ${name}_tail = R\"igsp(${tail})igsp\";\n\n}  // namespace igsp::cli\n")
endfunction()
