# shellcheck shell=bash
# Sourced by the scripts beside it: where the repository is, and how to speak.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
export root

say() { printf '%s\n' "$*"; }

die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# The comment at the top of a script is its help.
help_of() { sed -n '2,/^$/{s/^# \{0,1\}//p;}' "$1"; }

# wants_help ARGUMENT...: is the first one -h or --help? Then the help is printed.
wants_help() {
  case "${1:-}" in
    -h | --help)
      help_of "$0"
      return 0
      ;;
  esac
  return 1
}

# kind_of_sanitizer LIST: the ending of the folders that a sanitized build goes to.
kind_of_sanitizer() {
  case "$1" in
    "") ;;
    thread) printf -- '-tsan' ;;
    *address*) printf -- '-asan' ;;
    *) printf -- '-%s' "${1//,/-}" ;;
  esac
}
