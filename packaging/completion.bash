# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
#
# Completion of the programs that are on PATH, for bash: their subcommands and options, from their --help.
# `./franka completion` prints it; the Debian packages install it.
_franka_program() {
  local current=${COMP_WORDS[COMP_CWORD]} help subcommands=""
  [ "$COMP_CWORD" = 1 ] || [[ $current == -* ]] || return
  help=$("$1" --help 2>/dev/null </dev/null)
  # `one|two` on a line of its own, or the line `program one --help: ...`.
  subcommands=" $(sed -nE -e 's/^ +([a-z]+([|][a-z]+)+)$/\1/p' -e 's/^[a-z_]+ ([a-z]+) --help:.*/\1/p' <<<"$help" |
    tr '|\n' '  ')"
  if [ "$COMP_CWORD" = 1 ]; then
    [[ $current == -* || $subcommands == *[a-z]* ]] || return
  else
    [[ $subcommands != *" ${COMP_WORDS[1]} "* ]] || help=$("$1" "${COMP_WORDS[1]}" --help 2>/dev/null </dev/null)
    subcommands=""
  fi
  mapfile -t COMPREPLY < <(compgen -W "$subcommands $(grep -E '^ +-' <<<"$help" | grep -oE -e '[ ,]--[a-z][a-z-]*' |
    tr -d ' ,')" -- "$current" | sort -u)
}
complete -o default -F _franka_program franka_sim franka_info franka_plot franka_desk pyfranka-run pyfranka-sweep
