#!/usr/bin/env bash
# Prints tables as Markdown: the back-end beside Ceres, and how its time grows with the graph.
# Usage: LOOPGRID_DATA=FOLDER tests/benchmarks/compare_solvers.sh [options of Google Benchmark]
# (graphs are taken from FOLDER/graphs). Installs what is missing and builds.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

apps/install_packages.sh tests
cmake --preset benchmark >/dev/null
cmake --build --preset benchmark --target solver_benchmark >/dev/null

# name,iterations,real_time,cpu_time,time_unit,...,then a column for each counter.
# Use one thread; CHOLMOD would use more by default.
OMP_THREAD_LIMIT=1 build/benchmark/tests/benchmarks/solver_benchmark --benchmark_format=csv "$@" |
  awk -F, '
    function Unquoted(text) { gsub(/"/, "", text); return text }
    /^name,/ { for (i = 1; i <= NF; ++i) column[Unquoted($i)] = i; next }
    column["name"] {
      name = Unquoted($1)
      what = substr(name, 1, index(name, "/") - 1)
      graph = substr(name, index(name, "/") + 1)
      time = $(column["cpu_time"])
      if (Unquoted($(column["error_occurred"])) == "true") next
      memory = $(column["MB"])
      if (what == "loopgrid" || what == "growth") {
        key = graph
        order[++count] = key
        is_growth[key] = what == "growth"
        ours[key] = time
        ours_memory[key] = memory
        nodes[key] = $(column["nodes"])
        edges[key] = $(column["edges"])
        error[key] = $(column["F"])
        steps[key] = $(column["steps"])
      } else if (what == "marginals") {
        marginals[graph] = time
      } else if (!(graph in ceres) || time < ceres[graph]) {
        ceres[graph] = time
        ceres_memory[graph] = memory
        settings[graph] = substr(what, index(what, "-") + 1)
      }
    }
    END {
      print "| graph | nodes | edges | F | time | steps | marginals | memory | Ceres | its memory" \
            " | ratio |"
      print "|---|---|---|---|---|---|---|---|---|---|---|"
      for (i = 1; i <= count; ++i) {
        key = order[i]
        if (is_growth[key]) continue
        beside = "does not get there | |"
        if (key in ceres) {
          beside = sprintf("%.2f ms (%s) | %.0f MB | %.2f", ceres[key], settings[key],
                           ceres_memory[key], ours[key] / ceres[key])
        }
        printf "| %s | %d | %d | %s | %.2f ms | %d | %.2f ms | %.0f MB | %s |\n", key, nodes[key],
               edges[key], error[key], ours[key], steps[key], marginals[key], ours_memory[key], beside
      }
      print ""
      print "| generated city | edges | time | memory |"
      print "|---|---|---|---|"
      for (i = 1; i <= count; ++i) {
        key = order[i]
        if (!is_growth[key]) continue
        printf "| %s | %d | %.0f ms | %.0f MB |\n", key, edges[key], ours[key], ours_memory[key]
      }
    }'
