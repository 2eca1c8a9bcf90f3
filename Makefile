# make demo · make test · make bench · make bless · make lint · make shaders · make view · make web · make serve
# make test-page · make test-s3 · make looks · make session
#
# Each target sets up what it needs: see scripts/setup.sh.

SHELL := /bin/bash
# Silences the window-system probe of the Vulkan loader; nothing here opens a window.
export XDG_RUNTIME_DIR ?= /tmp
CARGO ?= cargo
ONLY ?=
# How `adapter` compiles the program that looks for one.
PROGRAM =
OUT ?= target/demo
PAGE ?= target/page
PORT ?= 8080
SCENE ?= examples/scenes/ruins.json

.PHONY: demo test test-page test-s3 bench bless lint shaders view web serve looks session setup adapter browser wasm

# Without the viewer and the server, which the demo has no use for, and which take as long to compile as all the rest.
demo: PROGRAM = --no-default-features
demo: adapter
	$(CARGO) run $(PROGRAM) --bin relievo -- demo --out $(OUT)
	@echo "open $(OUT)/index.html"

test: browser
	$(CARGO) test

# The viewer's page in Chromium. It compiles the page first, unless RELIEVO_PAGE is the folder that `make web` wrote.
test-page: browser
	$(CARGO) test --test page

# The server with its models in an object store: moto, which comes from PyPI.
test-s3: setup
	scripts/s3.sh $(CARGO) test --features relievo-delivery/s3 --test s3

# The demo's scene in the viewer, with a window.
view: PROGRAM = --release
view: adapter
	$(CARGO) run $(PROGRAM) --bin relievo -- view $(SCENE)

# The page with the viewer, and the sizes of its files.
web: wasm
	$(CARGO) run -p relievo-testing --bin page -- $(PAGE)

# The same, served on localhost beside the demo's scene, even if its files are larger than they should be.
serve: wasm
	-$(CARGO) run -p relievo-testing --bin page -- $(PAGE)
	$(CARGO) run --release --bin relievo -- serve --page $(PAGE) --scene $(SCENE) --cache target/cache --listen 127.0.0.1:$(PORT)

# Pictures of every section of the viewer's panel, and of thesis A's experiment, in target/viewer.
looks: adapter
	$(CARGO) test --test viewer -- --ignored --nocapture looks

# A session of 6,000 frames, after which the viewer holds as much memory as before. On SwiftShader, since Mesa 22.3's software
# adapter keeps half a megabyte of compiled shaders a frame.
session: browser
	VK_ICD_FILENAMES=/usr/lib/chromium/vk_swiftshader_icd.json RELIEVO_ADAPTER=swiftshader \
		$(CARGO) test --test viewer -- --ignored --nocapture session

bench: setup
	RELIEVO_COMMIT=$$(git rev-parse --short HEAD 2>/dev/null || echo unknown) $(CARGO) run --release --bin relievo -- bench $(if $(ONLY),--only $(ONLY)) --json target/bench/summary.json

# The only way to write a golden.
bless: adapter
	RELIEVO_BLESS=1 $(CARGO) test --test golden --test demo

# The generated shaders, after a change of kernels/, wgsl/ or crates/relievo-shaders/.
shaders: setup
	$(CARGO) run --bin relievo-shaders

lint: setup
	$(CARGO) fmt --all --check
	$(CARGO) clippy --all-targets -- -D warnings
	$(CARGO) clippy --test page -- -D warnings
	$(CARGO) clippy --no-default-features --bin relievo -- -D warnings
	$(CARGO) clippy -p relievo -p relievo-samples --no-default-features -- -D warnings
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --no-deps --document-private-items

setup:
	@scripts/setup.sh

# Opens a device, which tells more than a driver's file.
adapter:
	@CARGO=$(CARGO) PROGRAM=$(PROGRAM) scripts/setup.sh adapter

wasm: setup
	@CARGO=$(CARGO) scripts/setup.sh wasm

# After the adapter: two installations at once would wait for each other's lock, and fail.
browser: adapter
	@CARGO=$(CARGO) scripts/setup.sh browser
