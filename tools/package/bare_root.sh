# shellcheck shell=bash
# For scripts that try something in a bare root of Debian: `source` it, then make_root SUITE. The mirror and the proxy are those that apt
# is configured with. What is left when the script ends is removed, but with keep=yes.

export LC_ALL=C DEBIAN_FRONTEND=noninteractive
keep=
fail() { echo "$(basename -- "$0"): $*" >&2; exit 1; }

step() {  # WHAT COMMAND... : its words are shown where it fails
  echo "$1 ..."
  "${@:2}" >>"$log" 2>&1 || { tail -n 25 "$log" >&2; fail "$1: failed; its last words are above."; }
}

# A command in the root.
inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    ${http_proxy:+http_proxy="$http_proxy" https_proxy="$http_proxy"} "$@"
}

remove_root() {
  ! mountpoint -q "$root/proc" || umount "$root/proc"
  if [[ -n ${keep:-} ]]; then echo "The root is $root, its log $log"; else rm -rf --one-file-system "$root" "$log"; fi
}

# SUITE: bookworm, trixie, ... Sets root and log.
make_root() {
  local suite=$1 own mirror proxy=
  ((EUID == 0)) || fail "a bare root is made by root only."
  command -v debootstrap >/dev/null || fail "debootstrap is missing: install the package debootstrap."
  own=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
  # shellcheck disable=SC2016  # the variables are apt's
  mirror=$(apt-get indextargets --format '$(CODENAME) $(REPO_URI)' 'Created-By: Packages' | sed -n "s/^$own //p" | sed -n 1p)
  [[ -n $mirror ]] || fail "apt is not configured with a mirror of $own."
  eval "$(apt-config shell proxy Acquire::http::Proxy)"
  [[ -z $proxy || $proxy == DIRECT ]] || export http_proxy=$proxy https_proxy=$proxy
  root=$(mktemp -d)
  log=$root.log
  trap remove_root EXIT
  chmod 755 "$root"
  step "Making a bare root of $suite" debootstrap --variant=minbase "$suite" "$root" "$mirror"
  mount -t proc proc "$root/proc"
}
