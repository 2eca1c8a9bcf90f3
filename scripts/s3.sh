#!/bin/bash
# Runs a command beside moto's S3, which ends with it. Address and credentials are in the variables of the environment that
# `object_store` reads. moto comes from PyPI, into a virtual environment below `target`.
set -euo pipefail
folder=${CARGO_TARGET_DIR:-target}/moto
if [ ! -x "$folder/bin/moto_server" ]; then
    command -v python3 >/dev/null || { echo "missing: python3. Run: sudo apt-get install python3 python3-venv" >&2; exit 1; }
    python3 -m venv "$folder"
    "$folder/bin/pip" install --quiet 'moto[server]==5.1.*'
fi
port=$("$folder/bin/python" -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
"$folder/bin/moto_server" -H 127.0.0.1 -p "$port" >"$folder/server.log" 2>&1 &
server=$!
trap 'kill $server' EXIT
for _ in $(seq 100); do
    (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null && break
    kill -0 $server 2>/dev/null || { echo "moto ended: see $folder/server.log" >&2; exit 1; }
    sleep 0.1
done
export AWS_ENDPOINT=http://127.0.0.1:$port AWS_ALLOW_HTTP=true AWS_REGION=us-east-1
export AWS_ACCESS_KEY_ID=test AWS_SECRET_ACCESS_KEY=test
"$@"
