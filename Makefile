# Needs Python 3.10-3.12, a C/C++ compiler and cmake. ROS 2 Jazzy is used where it is sourced; elsewhere the same
# ROS 2 is installed as wheels into .venv. Every target sets up and builds what is missing or has changed.

SHELL := /bin/bash
.DEFAULT_GOAL := help
.PHONY: help build test test-computing test-timed test-slow fuzz lint format docs demo bench bench-cluster bench-far bench-hidden bench-recordings soak clean

ENVIRONMENT := . setup/environment.bash
PACKAGES := hasel_common hasel_recording hasel_driver hasel_tracker hasel_sim hasel_tracker_lab hasel_sysid hasel_muscle hasel_workbench hasel_bringup hasel_benchmark

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | expand -t 16

build: ## install the Python packages and build the ROS 2 workspace
	@setup/install_wheels.sh
	@$(ENVIRONMENT) && python setup/build_workspace.py

lint: build ## check style, format and types
	@$(ENVIRONMENT) && python -m ruff check . && python -m ruff format --check . && python -m mypy

format: build ## rewrite the code in the project's format
	@$(ENVIRONMENT) && { python -m ruff check --fix .; python -m ruff format .; }

# A test that hangs where no alarm is heard, as in a fixture, ends its process instead of the whole run.
WATCHED := -o faulthandler_timeout=1200 -o faulthandler_exit_on_timeout=true

# What keeps time (the driver's heartbeat, nodes) and what computes, at once: what computes, two tests at a time and the longest first,
# takes only what the other leaves of the processors, and has a ROS domain of its own. Both are run to their end.
TIMED := ros_ws/src/hasel_driver tests/nodes tests/ros2 tests/setup
COMPUTING := $(filter-out $(TIMED),$(patsubst %/,%,$(wildcard tests/*/ ros_ws/src/*/)))
IDLE := $(shell chrt --idle 0 true 2>/dev/null && echo chrt --idle 0 || echo nice -n 19)
TESTS := unset MAKEFLAGS MAKELEVEL; $(ENVIRONMENT) &&

test: lint ## lint, then every test but the slow ones
	@$(ENVIRONMENT) && python -m hasel_sim.first_run
	@$(MAKE) --no-print-directory --keep-going --jobs 2 test-computing test-timed

test-computing:
	@$(TESTS) ROS_DOMAIN_ID=215 $(IDLE) python -m pytest $(WATCHED) -o timeout=300 -n 2 --dist loadfile --no-loadscope-reorder $(COMPUTING)

test-timed:
	@$(TESTS) python -m pytest $(WATCHED) $(TIMED) > build/test-timed.txt 2>&1; status=$$?; cat build/test-timed.txt; exit $$status

test-slow: build ## the slow tests
	@$(ENVIRONMENT) && python -m pytest -m slow

fuzz: build ## readers and parameters against 22,000 damaged inputs (FUZZ_SHARE=0.1: a tenth of them)
	@$(ENVIRONMENT) && python -m pytest -q -o python_files='fuzz_*.py' -o python_functions='fuzz_*' -o timeout=7200 tests/fuzz

docs: build ## write the site, build/site/index.html, and the reference from the docstrings, build/site/code/index.html
	@$(ENVIRONMENT) && python -m pip install --quiet --disable-pip-version-check -r docs/requirements.txt
	@$(ENVIRONMENT) && NO_MKDOCS_2_WARNING=1 python -m mkdocs build --strict --quiet
	@$(ENVIRONMENT) && python -m pdoc --no-show-source -o build/site/code $(PACKAGES) '!hasel_bringup.launching' # ROS 2 from apt brings launch
	@echo "Written: build/site/index.html and build/site/code/index.html"

demo: build ## fit the swimmer, compare on unseen runs, replay one, write report.html (BODY=DIR, MUSCLE=DIR, FISHSIM=DIR: measured ones too)
	@bin/ros2-run hasel_bringup demo $(foreach folder,$(BODY) $(BEAM),--body $(folder)) $(foreach folder,$(MUSCLE),--muscle $(folder)) $(foreach folder,$(FISHSIM),--fish $(folder))

bench: build ## measure the speeds that docs/results/index.md states
	@bin/ros2-run hasel_bringup bench
	@bin/ros2-run hasel_tracker_lab bench

bench-hidden: build ## measure how often the right hidden effect is named
	@bin/ros2-run hasel_benchmark bench_hidden

bench-fits: build ## measure how often a fit ends as likely as the truth
	@bin/ros2-run hasel_benchmark bench_fits

bench-cluster: build ## measure how much sooner two workers of a Dask cluster answer than one
	@bin/ros2-run hasel_benchmark bench_cluster

bench-recordings: build ## measure what `improve` costs for 10, 30 and 100 recordings
	@bin/ros2-run hasel_benchmark bench_recordings

bench-far: build ## measure how often a constant that is far off is named
	@bin/ros2-run hasel_benchmark bench_far

soak: build ## run the virtual rig for 10 minutes and kill each node once (MINUTES=2: shorter)
	@bin/ros2-run hasel_bringup soak --minutes $(or $(MINUTES),10)

clean: ## remove what was built, but not .venv
	@rm -rf build install log
