#!/bin/sh
# The command `etendue` of the Debian package: starts the best build of the program that this processor can run.
# ETENDUE_ARCHITECTURE chooses another.
prefix=/usr/lib/etendue
if [ -z "$ETENDUE_ARCHITECTURE" ]; then
  ETENDUE_ARCHITECTURE=$(awk -v prefix="$prefix" '
    FILENAME != "/proc/cpuinfo" { if (!/^#/) lines[++count] = $0; next }
    /^flags/ { flags = " " $0 " "; exit }
    END {
      for (i = count; i > 0; --i) {  # each needs what those after it in the file need
        words = split(lines[i], word, /[: ]+/)
        for (j = 2; j <= words; ++j) if (!index(flags, " " word[j] " ")) { print best; exit }
        if (system("test -d " prefix "/" word[1]) == 0) best = word[1]
      }
      print best
    }' "$prefix/share/etendue/architectures.txt" /proc/cpuinfo)
  if [ -z "$ETENDUE_ARCHITECTURE" ] && [ -d "$prefix/native" ]; then ETENDUE_ARCHITECTURE=native; fi
fi
if [ ! -x "$prefix/$ETENDUE_ARCHITECTURE/etendue" ]; then
  echo "etendue: there is no build for this processor, or for ETENDUE_ARCHITECTURE: '$ETENDUE_ARCHITECTURE'" >&2
  exit 1
fi
exec "$prefix/$ETENDUE_ARCHITECTURE/etendue" "$@"
