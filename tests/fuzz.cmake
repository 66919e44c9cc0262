# Hostile input: fuzz targets replayed, allocations and writes that fail.
add_subdirectory(fuzz)
