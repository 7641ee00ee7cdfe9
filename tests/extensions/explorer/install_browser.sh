#!/bin/sh
# Provide a browser for the tests of the explorer: install_browser.sh PYTHON
#
# Takes a chromium that is installed; else the one that playwright brings (of the environment of PYTHON); else, as root on Debian and
# its relatives, the system's package. If none can be had, says so: the browser tests are then skipped. Never fails.

python=${1:-python3}

for name in chromium chromium-browser google-chrome; do
    command -v "$name" >/dev/null 2>&1 && { echo "browser: $(command -v "$name")"; exit 0; }
done

if "$python" -m playwright install --with-deps chromium >/dev/null 2>&1 || "$python" -m playwright install chromium >/dev/null 2>&1
then
    echo "browser: chromium, brought by playwright"
    exit 0
fi

if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null 2>&1; then
    if { apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends chromium; } >/dev/null 2>&1
    then
        echo "browser: chromium, installed by apt-get"
        exit 0
    fi
fi

echo "browser: no chromium was found, and none could be installed: the browser tests of the explorer are skipped"
