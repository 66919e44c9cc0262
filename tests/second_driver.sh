#!/bin/sh
# second_driver.sh COMMAND...: runs a test with Vulkan's second software driver, SwiftShader, which browsers of the
# Chromium family bring (Debian: chromium-common, with chromium-headless-shell or chromium), or with the driver whose
# JSON file HNBRDF_SECOND_DRIVER names. Skipped (77) where there is none.
# HNBRDF_BESIDE=1: beside the other drivers, all in one process, otherwise alone.
set -eu
json=${HNBRDF_SECOND_DRIVER:-}
for directory in /usr/lib/chromium /usr/lib/chromium-browser /opt/google/chrome /usr/lib/swiftshader; do
    [ -n "$json" ] || [ ! -f "$directory/vk_swiftshader_icd.json" ] || json=$directory/vk_swiftshader_icd.json
done
[ -n "$json" ] || { echo "skipped: no second Vulkan driver (SwiftShader) here"; exit 77; }
[ -f "$json" ] || { echo "failed: HNBRDF_SECOND_DRIVER is $json, expected a driver's JSON file"; exit 1; }
if [ -n "${HNBRDF_BESIDE:-}" ]; then
    VK_ADD_DRIVER_FILES=$json
    export VK_ADD_DRIVER_FILES
else
    VK_DRIVER_FILES=$json VK_ICD_FILENAMES=$json # the second name is that of loaders before 1.3.207
    export VK_DRIVER_FILES VK_ICD_FILENAMES
fi
echo "driver: $json"
exec "$@"
