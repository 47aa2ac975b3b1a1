# shellcheck shell=bash
# What run_tests needs for tests under a sanitizer. It uses functions and variables of setup.sh.

sanitizers=$repository/test/sanitizers

# short_programs SANITIZER: prints the names of the few test programs for .ci/run.
short_programs() { awk -v sanitizer="$1" '$1 == sanitizer {print $2}' "$sanitizers/short.txt"; }

# short_tests SANITIZER FOLDER: runs the few tests for .ci/run of the programs in this folder.
short_tests() {
  local kind program filter
  while read -r kind program filter; do
    if [ "$kind" = "$1" ]; then under_sanitizer "$1" "$2/$program" --gtest_brief=1 --gtest_filter="$filter"; fi
  done < "$sanitizers/short.txt"
}

# left_out_tests SANITIZER: prints a regular expression for the names of the tests that it leaves out.
left_out_tests() {
  awk -v sanitizer="$1" '
    ($1 == sanitizer || $1 == "both") && $2 !~ /:/ {
      gsub(/\./, "[.]", $2)
      names = names (names ? "|" : "") "^" $2 "$|_" $2 "$"
    }
    END {print names}' "$sanitizers/left_out.txt"
}

# left_out_patterns SANITIZER: prints a filter for gtest of the tests in programs that it leaves out.
left_out_patterns() {
  awk -v sanitizer="$1" '
    ($1 == sanitizer || $1 == "both") && $2 ~ /:/ {
      sub(/.*:/, "", $2)
      patterns = patterns ":" $2
    }
    END {print "-" substr(patterns, 2)}' "$sanitizers/left_out.txt"
}

# is_of_parser REPORT: whether it tells of a crash within the parsers of robot files. They run in robot_reader, and tests
# crash them on purpose.
is_of_parser() {
  grep -qE "ERROR: (Address|Thread)Sanitizer" "$1" &&
    grep -m 6 -E '^ +#[0-5] ' "$1" | grep -qE 'lib(assimp|urdfdom_model)[.]so'
}

# under_sanitizer SANITIZER COMMAND...: runs it, and prints what the sanitizer found. Fails if the command fails or if
# there is anything.
under_sanitizer() {
  local sanitizer=$1 result=0 report log=$build/found
  shift
  export GTEST_FILTER
  GTEST_FILTER=$(left_out_patterns "$sanitizer")
  rm -rf "$log"
  mkdir -p "$log"
  # A node that is reported ends with an error, but its test may not notice. The files tell of all programs.
  export ASAN_OPTIONS="suppressions=$sanitizers/address.supp log_path=$log/report"
  export LSAN_OPTIONS="suppressions=$sanitizers/leak.supp print_suppressions=0"
  export UBSAN_OPTIONS="log_path=$log/report print_stacktrace=1"
  # What libraries without checks do with memory is left out, because the sanitizer does not see how they synchronize.
  export TSAN_OPTIONS="suppressions=$sanitizers/thread.supp ignore_noninstrumented_modules=1 history_size=4"
  TSAN_OPTIONS+=" log_path=$log/report"
  # The program nodelet is built without a sanitizer, which must be loaded before our libraries.
  export ORGAN_COLLISION_NODELET_PREFIX="env LD_PRELOAD=$(gcc -print-file-name="lib${sanitizer:0:1}san.so")"
  # Without random addresses, because ThreadSanitizer needs some of them.
  setarch --addr-no-randomize "$@" || result=1
  for report in "$log"/report*; do
    [ -e "$report" ] || continue
    if is_of_parser "$report"; then continue; fi
    say "Found: $report"
    cat "$report"
    result=1
  done
  return $result
}
