# embed.cmake: turns a text file into a C array:
#   cmake -DINPUT=... -DOUTPUT=... -DNAME=... -P embed.cmake
file(READ "${INPUT}" hex HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
string(REPEAT "0x..," 12 twelve)
string(REGEX REPLACE "(${twelve})" "\\1\n" bytes "${bytes}")
file(WRITE "${OUTPUT}.tmp" "extern const char ${NAME}[];\nconst char ${NAME}[] = {\n${bytes}0};\n")
file(RENAME "${OUTPUT}.tmp" "${OUTPUT}")
