"""Programs that stand in, first on the PATH, for those that the commands of pages call and that a
test cannot run: they would build, need root or need a cluster. Each checks what it is given."""
from stand_ins import INSTALLED, write_program

# Folders, presets and targets must exist. The preset `bench` makes a benchmark of equal times.
CMAKE = r"""
fail() { echo "cmake: $*" >&2; exit 1; }
preset() { grep -q "\"name\": \"$1\"" CMakePresets.json || fail "no preset '$1'"; }
case $1 in
  --preset) preset "$2" ;;
  --install) [[ -e $2/cmake_install.cmake || $2 == build/portable ]] || fail "no build $2"
    [[ $3 == --prefix && -n $4 ]] || fail "no prefix" ;;
  --build) if [[ $2 == --preset ]]; then
      preset "$3"
      [[ $3 != bench ]] || make_toy build/bench
    elif [[ $3 == --target ]]; then
      grep -q "^build $4:" "$2/build.ninja" || fail "no target '$4' in $2"
    fi ;;
  *) fail "unknown words: $*" ;;
esac
"""
# make_toy BUILD: a build with one benchmark.
MAKE_TOY = r"""
mkdir -p "$1/experiments/benchmarks"
cat >"$1/experiments/benchmarks/bench_toy" <<'TOY'
#!/usr/bin/env bash
for word in "$@"; do [[ $word != --benchmark_out=* ]] || out=${word#*=}; done
row='{"name": "step/1", "run_type": "iteration", "cpu_time": 10000}'
echo "{\"context\": {}, \"benchmarks\": [$row, $row, $row]}" >"$out"
TOY
chmod +x "$1/experiments/benchmarks/bench_toy"
"""
SUDO = r"""
[[ $1 =~ ^apt(-get)?$ && $2 == install && $# -gt 2 ]] || { echo "sudo: $*" >&2; exit 1; }
for name in "${@:3}"; do
  [[ $name =~ ^[a-z0-9][a-z0-9+.-]+$ || $name == ./*.deb ]] || { echo "no package: $name" >&2; exit 1; }
done
"""
# Runs the tasks of a job at once.
SBATCH = r"""
job=${!#}
tasks=$(sed -n 's/^#SBATCH --array=1-//p' "$job")
for ((i = 1; i <= ${tasks:-1}; ++i)); do
  SLURM_ARRAY_TASK_ID=$i bash "$job" >&2 || (($? == 3)) || exit 1
done
echo 7
"""
SNAKEMAKE = r"""
[[ $1 == --snakefile && $3 == --directory ]] || exit 1
cd "$4" || exit 1
parts=$(($(sed -n 's/.*range(1, \([0-9]*\)).*/\1/p' "$2" | head -n 1) - 1))
for ((i = 1; i <= parts; ++i)); do ./part.sh "$i" || (($? == 3)) || exit 1; done
./merge.sh
"""
# The recipe and the folder of packages must exist.
BUILDAH = r"""
[[ $1 == build && $2 == -f && -f $3 && $4 == -t && -n $5 && -d $6 && $# == 6 ]] || { echo "buildah: $*" >&2; exit 1; }
compgen -G "$6/*.deb" >/dev/null
"""
# The words after the name of the image are those of ./tress.
PODMAN = r"""
[[ "$1 $2 $3 $4 $5" == "run --rm -v $PWD:/data tress" ]] || { echo "podman: $*" >&2; exit 1; }
exec ./tress "${@:6}"
"""
PROGRAMS = {
    "buildah": BUILDAH, "podman": PODMAN,
    "cmake": CMAKE, "make_toy": MAKE_TOY, "sudo": SUDO, "sbatch": SBATCH, "snakemake": SNAKEMAKE,
    "dpkg-query": INSTALLED, "id": "echo 0", "apt-get": "exit 1", "squeue": "exit 0",
    "mpirun": '[[ $1 == -n && $2 =~ ^[0-9]+$ ]] || exit 1\nexec "${@:3}"',
    "tress": 'exec ./tress "$@"',
}
ENVIRONMENT = {f"GIT_{who}_{what}": "a@b" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}


def write_all(folder):
    for name, body in PROGRAMS.items():
        write_program(folder / name, body)
