# embed.cmake: turns a file into a C array that a 0 follows:
#   cmake -DINPUT=... -DOUTPUT=... -DNAME=... -P embed.cmake
# With -DSIZE=name it is one of unsigned char, and its length an int of that name.
file(READ "${INPUT}" hex HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
string(REPEAT "0x..," 12 twelve)
string(REGEX REPLACE "(${twelve})" "\\1\n" bytes "${bytes}")
set(type char)
if(DEFINED SIZE)
  set(type "unsigned char")
endif()
file(WRITE "${OUTPUT}.tmp"
  "extern const ${type} ${NAME}[];\nconst ${type} ${NAME}[] = {\n${bytes}0};\n")
if(DEFINED SIZE)
  file(APPEND "${OUTPUT}.tmp"
    "extern const int ${SIZE};\nconst int ${SIZE} = sizeof ${NAME} - 1;\n")
endif()
file(RENAME "${OUTPUT}.tmp" "${OUTPUT}")
