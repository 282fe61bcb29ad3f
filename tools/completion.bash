# Completes goshawk and tools/goshawk in bash: source tools/completion.bash
#
# The program itself is asked what may follow: its one parser knows, so this is never out of date.

_goshawk() {
  local choices
  choices=$("${COMP_WORDS[0]}" complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  mapfile -t COMPREPLY < <(compgen -W "$choices" -- "${COMP_WORDS[COMP_CWORD]}")
}

# Without a choice of ours, bash completes files.
complete -o default -F _goshawk goshawk tools/goshawk
