# add_shader.cmake: hnbrdf_add_shader(), here, in projects that include this one, and in those that
# find the installed package, which call the file hnbrdfAddShader.cmake.
#
#   hnbrdf_add_shader(TARGET MODEL [MATERIAL...] [OUTPUT FILE]
#     [LANGUAGE L] [PREFIX P] [WEIGHTS W] [WEIGHTS_OUT FILE] [PRECISION P] [ONLY FUNCTIONS]
#     [PACK P] [TEXELS FILE] [FIXED] [EDITABLE] [STANDALONE] [EXACT] [CONSERVE] [STRIP_COMMENTS]
#     [OPTIONS WORD...])
#
# Before TARGET is built, `hnbrdf export` writes MODEL and these materials of it (all, if none is
# named) as shader code to OUTPUT, and again when MODEL or the command changes. The words are those
# of `hnbrdf export --help`; OPTIONS takes any other of its options. MODEL is relative to the source
# folder, or, where nothing is there, to the build folder, and may be the output of another command.
# OUTPUT and other files are relative to the build folder; OUTPUT is TARGET.glsl by default, or has
# the language for its ending. The files are appended to the property HNBRDF_SHADERS of TARGET, to
# be named in DEPENDS of what compiles them.
#
# The command is HNBRDF_COMMAND where that is set (it must run on this machine), or the one that is
# built here or installed with the package, or that of PATH.
function(hnbrdf_add_shader target model)
  set(choices OUTPUT LANGUAGE PREFIX WEIGHTS WEIGHTS_OUT PRECISION ONLY PACK TEXELS)
  set(flags FIXED EDITABLE STANDALONE EXACT CONSERVE STRIP_COMMENTS)
  cmake_parse_arguments(PARSE_ARGV 2 SHADER "${flags}" "${choices}" "OPTIONS")
  if(NOT TARGET ${target})
    message(FATAL_ERROR "hnbrdf_add_shader: no target ${target}")
  endif()
  if(SHADER_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR
      "hnbrdf_add_shader(${target}): no value after ${SHADER_KEYWORDS_MISSING_VALUES}")
  endif()
  _hnbrdf_find_command(command)

  if(NOT SHADER_OUTPUT)
    set(ending glsl)
    if(SHADER_LANGUAGE)
      set(ending ${SHADER_LANGUAGE})
    endif()
    set(SHADER_OUTPUT ${target}.${ending})
  endif()
  if(NOT IS_ABSOLUTE "${model}" AND EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/${model}")
    set(model "${CMAKE_CURRENT_SOURCE_DIR}/${model}")
  elseif(NOT IS_ABSOLUTE "${model}")
    set(model "${CMAKE_CURRENT_BINARY_DIR}/${model}")
  endif()
  set(words "${model}")
  if(SHADER_UNPARSED_ARGUMENTS)
    list(JOIN SHADER_UNPARSED_ARGUMENTS "," materials)
    list(APPEND words --materials "${materials}")
  endif()
  set(files "")
  foreach(choice ${choices})
    if(SHADER_${choice})
      set(value "${SHADER_${choice}}")
      if(choice MATCHES "^(OUTPUT|WEIGHTS_OUT|TEXELS)$")
        if(NOT IS_ABSOLUTE "${value}")
          set(value "${CMAKE_CURRENT_BINARY_DIR}/${value}")
        endif()
        list(APPEND files "${value}")
      endif()
      string(TOLOWER "--${choice}" option)
      string(REPLACE _ - option ${option})
      list(APPEND words ${option} "${value}")
    endif()
  endforeach()
  foreach(flag ${flags})
    if(SHADER_${flag})
      string(TOLOWER "--${flag}" option)
      string(REPLACE _ - option ${option})
      list(APPEND words ${option})
    endif()
  endforeach()
  list(GET files 0 output)
  get_filename_component(folder "${output}" DIRECTORY)
  file(MAKE_DIRECTORY "${folder}")

  add_custom_command(OUTPUT ${files}
    COMMAND ${command} export ${words} ${SHADER_OPTIONS}
    DEPENDS "${model}" ${command}
    COMMENT "Exporting the materials of ${target}" VERBATIM)
  get_property(before TARGET ${target} PROPERTY HNBRDF_SHADERS)
  list(LENGTH before count)
  add_custom_target(${target}_hnbrdf_shader_${count} DEPENDS ${files})
  add_dependencies(${target} ${target}_hnbrdf_shader_${count})
  set_property(TARGET ${target} APPEND PROPERTY HNBRDF_SHADERS ${files})
endfunction()

# The command that hnbrdf_add_shader() runs: a path, or a target of this build.
function(_hnbrdf_find_command result)
  if(HNBRDF_COMMAND)
    set(found "${HNBRDF_COMMAND}")
  elseif(TARGET hnbrdf_cli AND NOT CMAKE_CROSSCOMPILING)
    set(found hnbrdf_cli)
  else()
    get_property(folder GLOBAL PROPERTY HNBRDF_BIN_DIR)
    find_program(HNBRDF_COMMAND hnbrdf HINTS "${folder}"
      DOC "the command hnbrdf, for hnbrdf_add_shader()")
    mark_as_advanced(HNBRDF_COMMAND)
    set(found "${HNBRDF_COMMAND}")
  endif()
  if(NOT found)
    message(FATAL_ERROR "hnbrdf_add_shader: no command hnbrdf was found. Install it, set "
      "HNBRDF_COMMAND to one that runs here, or build it: HNBRDF_BUILD_CLI=ON")
  endif()
  set(${result} "${found}" PARENT_SCOPE)
endfunction()
