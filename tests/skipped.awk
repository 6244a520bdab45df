# SPDX-License-Identifier: Apache-2.0
# Reads the log of ctest and prints which single tests of GoogleTest and of Node, and which whole scripts,
# were skipped, by reason.
function note(name, why) {
  count++
  names[why] = names[why] (names[why] ? ", " : "") name
}
/: Skipped$/ {
  place = $1
  sub(/.*\//, "", place)
  sub(/:$/, "", place)
  getline why
  note(place, why)
}
/^Command: / { script = $NF; sub(/.*\//, "", script); sub(/"$/, "", script) }
/^The package .* of npm is not installed, so this script is skipped\.$/ {
  sub(/, so this.*/, "")
  note("all of " script, $0)
}
/ # SKIP/ {
  why = name = $0
  sub(/.* # SKIP */, "", why)
  sub(/ *(\([0-9.]+ms\))? # SKIP.*/, "", name)
  sub(/^ *(ok [0-9]+ - |[^ A-Za-z0-9]+ )/, "", name)
  note(name, why == "" ? "no reason given" : why)
}
END {
  if (count) print count " tests were skipped:"
  for (why in names) print "  " why ": " names[why]
}
