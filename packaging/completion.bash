# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
#
# Completion of the programs that are on PATH, for bash: their options, from their --help. `./franka completion` prints it;
# the Debian packages install it.
_franka_program() {
  local current=${COMP_WORDS[COMP_CWORD]} subcommand=()
  if [ "$1" = franka_plot ] && [ "$COMP_CWORD" = 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "robot topic bag log --list --help" -- "$current")
  elif [[ $current == -* ]]; then
    [[ ${COMP_WORDS[1]} == -* ]] || subcommand=("${COMP_WORDS[1]}")
    mapfile -t COMPREPLY < <(compgen -W "$("$1" "${subcommand[@]}" --help 2>/dev/null </dev/null |
      grep -oE -e '(^|[[ ,])--[a-z][a-z-]*' | tr -d '[ ,')" -- "$current" | sort -u)
  fi
}
complete -o default -F _franka_program franka_sim franka_info franka_plot franka_desk pyfranka-run pyfranka-sweep
