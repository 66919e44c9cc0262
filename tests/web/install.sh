#!/bin/sh
# install.sh FOLDER: the npm packages of package-lock.json, exact versions with their checksums, into FOLDER of the
# build tree, never into the source tree. Nothing to do where they are there already. Packages' own scripts are
# not run. Skipped (77) without node and npm, or where nothing can be downloaded.
set -eu
source=$(cd "$(dirname "$0")" && pwd)
folder=$1
for tool in node npm; do
    command -v $tool > /dev/null || { echo "skipped: no $tool"; exit 77; }
done
cmp -s "$source/package-lock.json" "$folder/installed" && { echo "installed before: $folder"; exit 0; }
mkdir -p "$folder"
rm -f "$folder/installed"
cp "$source/package.json" "$source/package-lock.json" "$folder"
log=$folder/npm.log
(cd "$folder" && npm ci --ignore-scripts --legacy-peer-deps --no-audit --no-fund --fetch-retries=1 \
    --fetch-timeout=120000) > "$log" 2>&1 || {
    # A wrong lock file or checksum is an error of ours; a network that is not there is none.
    if grep -qE 'ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ECONNRESET|ETIMEDOUT|ENETUNREACH|network|E40[37]|E50' "$log"; then
        echo "skipped: nothing can be downloaded: $(grep -m 1 -E 'code E|network' "$log")"
        exit 77
    fi
    tail -n 20 "$log"
    exit 1
}
cp "$source/package-lock.json" "$folder/installed"
echo "installed: $(du -sh "$folder" | cut -f 1) in $folder"
