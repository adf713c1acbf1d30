# Made by `palpate help --completion bash`.
_palpate() {
  local word=${COMP_WORDS[COMP_CWORD]} last=${COMP_WORDS[COMP_CWORD-1]} verb= i
  for ((i = 1; i < COMP_CWORD; i++)); do
    if [[ ${COMP_WORDS[i]} != -* ]]; then verb=${COMP_WORDS[i]}; break; fi
  done
  local options= words=
  case $verb in
    '') words='touch view replay import bake pack convert info check query explain render report bench accuracy devices doctor help'; options='--help --version --json --quiet --force' ;;
    touch)
      options='--path --as-recorded --press --stroke --tap --insert --normal --depth --clearance --speed --hold --repeats --frequency --taps --back --renderer --rate --device --hand --delay --seconds --realtime --set --serial --descriptor --firmware --calibration --library --service --epsilon --halvings --alpha --alpha-form --interior --passivity --hand-force --coupling --max-force --slew --ramp --trace --record --states --image --plot --write-scene --above --distances --labels --names --layer --voxel --units --affine --space --frame --series --resample --json --quiet --no-cache --force -h --help'
      words=FILES
      case $last in
        --path) words=FILES ;;
        --press) words=NONE ;;
        --stroke) words=NONE ;;
        --tap) words=NONE ;;
        --insert) words=NONE ;;
        --normal) words=NONE ;;
        --depth) words=NONE ;;
        --clearance) words=NONE ;;
        --speed) words=NONE ;;
        --hold) words=NONE ;;
        --repeats) words=NONE ;;
        --frequency) words=NONE ;;
        --taps) words=NONE ;;
        --renderer) words='constraint paper' ;;
        --rate) words=NONE ;;
        --device) words=NONE ;;
        --hand) words=NONE ;;
        --delay) words=NONE ;;
        --seconds) words=NONE ;;
        --set) words=NONE ;;
        --serial) words=NONE ;;
        --descriptor) words=NONE ;;
        --firmware) words=FILES ;;
        --calibration) words=FILES ;;
        --library) words=FILES ;;
        --service) words=NONE ;;
        --epsilon) words=NONE ;;
        --halvings) words=NONE ;;
        --alpha) words=NONE ;;
        --alpha-form) words='by_field newton printed' ;;
        --interior) words='together wall' ;;
        --passivity) words='control observe' ;;
        --hand-force) words=NONE ;;
        --coupling) words=NONE ;;
        --max-force) words=NONE ;;
        --slew) words=NONE ;;
        --ramp) words=NONE ;;
        --trace) words=FILES ;;
        --record) words=FILES ;;
        --states) words=NONE ;;
        --image) words=FILES ;;
        --plot) words=FILES ;;
        --write-scene) words=FILES ;;
        --above) words=NONE ;;
        --labels) words=NONE ;;
        --names) words=FILES ;;
        --layer) words=NONE ;;
        --voxel) words=NONE ;;
        --units) words=NONE ;;
        --affine) words='qform sform spacing' ;;
        --space) words='LPS RAS' ;;
        --frame) words=NONE ;;
        --series) words=NONE ;;
      esac
      ;;
    view)
      options='--device --hand --delay --replay --seconds --renderer --serial --descriptor --firmware --calibration --library --service --port --no-open --record --json --quiet --no-cache --force -h --help'
      words=FILES
      case $last in
        --device) words=NONE ;;
        --hand) words=NONE ;;
        --delay) words=NONE ;;
        --replay) words=FILES ;;
        --seconds) words=NONE ;;
        --renderer) words='constraint paper' ;;
        --serial) words=NONE ;;
        --descriptor) words=NONE ;;
        --firmware) words=FILES ;;
        --calibration) words=FILES ;;
        --library) words=FILES ;;
        --service) words=NONE ;;
        --port) words=NONE ;;
        --record) words=FILES ;;
      esac
      ;;
    replay)
      options='--scene --renderer --from --json --quiet --no-cache -h --help'
      words=FILES
      case $last in
        --scene) words=FILES ;;
        --renderer) words='constraint paper' ;;
        --from) words=NONE ;;
      esac
      ;;
    import)
      options='-o --output --dry-run --labels --region --names --min-island --islands --image --skin --body --tissue --tissue-file --codes --strict --to --burr-hole --way --hounsfield --materials --voxel --priority --affine --space --frame --series --resample --json --quiet --force -h --help'
      words=FILES
      case $last in
        -o|--output) words=FILES ;;
        --labels) words=NONE ;;
        --region) words=NONE ;;
        --names) words=FILES ;;
        --min-island) words=NONE ;;
        --islands) words='drop merge' ;;
        --image) words=FILES ;;
        --skin) words=NONE ;;
        --body) words=FILES ;;
        --tissue) words=NONE ;;
        --tissue-file) words=FILES ;;
        --codes) words='freesurfer' ;;
        --to) words=NONE ;;
        --burr-hole) words=NONE ;;
        --way) words=FILES ;;
        --materials) words=FILES ;;
        --voxel) words=NONE ;;
        --priority) words=NONE ;;
        --affine) words='qform sform spacing' ;;
        --space) words='LPS RAS' ;;
        --frame) words=NONE ;;
        --series) words=NONE ;;
      esac
      ;;
    bake)
      options='-o --output --parts --voxel --half-width --max-memory --layer --units --sign --shell --smooth --affine --space --frame --series --resample --above --distances --keep --fill --labels --names --json --quiet --no-cache --force -h --help'
      words=FILES
      case $last in
        -o|--output) words=FILES ;;
        --parts) words=FILES ;;
        --voxel) words=NONE ;;
        --half-width) words=NONE ;;
        --max-memory) words=NONE ;;
        --layer) words=NONE ;;
        --units) words=NONE ;;
        --sign) words='flood unsigned vote winding' ;;
        --shell) words=NONE ;;
        --smooth) words=NONE ;;
        --affine) words='qform sform spacing' ;;
        --space) words='LPS RAS' ;;
        --frame) words=NONE ;;
        --series) words=NONE ;;
        --above) words=NONE ;;
        --keep) words='all largest' ;;
        --labels) words=NONE ;;
        --names) words=FILES ;;
      esac
      ;;
    pack)
      options='-o --output --json --quiet --no-cache --force -h --help'
      words=FILES
      case $last in
        -o|--output) words=NONE ;;
      esac
      ;;
    convert)
      options='-o --output --to-units --voxel --half-width --max-memory --layer --units --sign --shell --smooth --affine --space --frame --series --resample --above --distances --keep --fill --labels --names --level-set --json --quiet --no-cache --force -h --help'
      words=FILES
      case $last in
        -o|--output) words=FILES ;;
        --to-units) words=NONE ;;
        --voxel) words=NONE ;;
        --half-width) words=NONE ;;
        --max-memory) words=NONE ;;
        --layer) words=NONE ;;
        --units) words=NONE ;;
        --sign) words='flood unsigned vote winding' ;;
        --shell) words=NONE ;;
        --smooth) words=NONE ;;
        --affine) words='qform sform spacing' ;;
        --space) words='LPS RAS' ;;
        --frame) words=NONE ;;
        --series) words=NONE ;;
        --above) words=NONE ;;
        --keep) words='all largest' ;;
        --labels) words=NONE ;;
        --names) words=FILES ;;
      esac
      ;;
    info)
      options='--units --names --affine --space --frame --series --resample --json --quiet -h --help'
      words=FILES
      case $last in
        --units) words=NONE ;;
        --names) words=FILES ;;
        --affine) words='qform sform spacing' ;;
        --space) words='LPS RAS' ;;
        --frame) words=NONE ;;
        --series) words=NONE ;;
      esac
      ;;
    check)
      options='--units --space --voxel --layer --level-set --json --quiet --no-cache -h --help'
      words=FILES
      case $last in
        --units) words=NONE ;;
        --space) words='LPS RAS' ;;
        --voxel) words=NONE ;;
        --layer) words=NONE ;;
      esac
      ;;
    query)
      options='--field --at --points --affine --space --frame --series --resample --json --quiet --no-cache -h --help'
      words=FILES
      case $last in
        --field) words=NONE ;;
        --at) words=NONE ;;
        --points) words=FILES ;;
        --affine) words='qform sform spacing' ;;
        --space) words='LPS RAS' ;;
        --frame) words=NONE ;;
        --series) words=NONE ;;
      esac
      ;;
    explain)
      options='--measure --device --hand --delay --rate --svg --json --quiet --no-cache --force -h --help'
      words=FILES
      case $last in
        --device) words=NONE ;;
        --hand) words=NONE ;;
        --delay) words=NONE ;;
        --rate) words=NONE ;;
        --svg) words=FILES ;;
      esac
      ;;
    render)
      options='-o --output --size --plane --cut --trace --image --iso --forces --view --around --opacity --slice --turn --replay --json --quiet --no-cache --force -h --help'
      words=FILES
      case $last in
        -o|--output) words=FILES ;;
        --size) words=NONE ;;
        --plane) words=NONE ;;
        --cut) words=NONE ;;
        --trace) words=FILES ;;
        --image) words=FILES ;;
        --iso) words=NONE ;;
        --forces) words=NONE ;;
        --view) words=NONE ;;
        --around) words=NONE ;;
        --opacity) words=NONE ;;
        --slice) words=NONE ;;
        --turn) words=NONE ;;
        --replay) words=NONE ;;
      esac
      ;;
    report)
      options='-o --output --device --hand --delay --rate --json --quiet --no-cache --force -h --help'
      words=FILES
      case $last in
        -o|--output) words=FILES ;;
        --device) words=NONE ;;
        --hand) words=NONE ;;
        --delay) words=NONE ;;
        --rate) words=NONE ;;
      esac
      ;;
    bench)
      options='--scene --renderer --device --full --repeat --paced --cold --rate --seconds --load --csv --svg --curvature-svg --json --quiet --force -h --help'
      words=FILES
      case $last in
        --scene) words=NONE ;;
        --renderer) words=NONE ;;
        --device) words=NONE ;;
        --repeat) words=NONE ;;
        --paced) words=NONE ;;
        --cold) words=NONE ;;
        --rate) words=NONE ;;
        --seconds) words=NONE ;;
        --load) words=NONE ;;
        --csv) words=FILES ;;
        --svg) words=FILES ;;
        --curvature-svg) words=FILES ;;
      esac
      ;;
    accuracy)
      options='--field --voxel --ladder --sampler --points --band --repeat --csv --svg --json --quiet --no-cache --force -h --help'
      words=FILES
      case $last in
        --field) words=NONE ;;
        --voxel) words=NONE ;;
        --ladder) words=NONE ;;
        --sampler) words='accessor cubic trilinear' ;;
        --points) words=NONE ;;
        --band) words=NONE ;;
        --repeat) words=NONE ;;
        --csv) words=FILES ;;
        --svg) words=FILES ;;
      esac
      ;;
    devices)
      options='--test --calibrate --states --seconds --serial --descriptor --firmware --calibration --library --service --json --quiet --force -h --help'
      words=FILES
      case $last in
        --test) words=NONE ;;
        --calibrate) words=FILES ;;
        --seconds) words=NONE ;;
        --serial) words=NONE ;;
        --descriptor) words=NONE ;;
        --firmware) words=FILES ;;
        --calibration) words=FILES ;;
        --library) words=FILES ;;
        --service) words=NONE ;;
      esac
      ;;
    doctor)
      options='--json --quiet -h --help'
      words=FILES
      ;;
    help)
      options='--markdown --schema --man --completion -h --help'
      if ((COMP_CWORD == i + 1)); then words='touch view replay import bake pack convert info check query explain render report bench accuracy devices doctor help scene'
      elif [[ ${COMP_WORDS[i+1]} == scene ]]; then words='above affine after alpha amplitude axis back baked balls base below between box capsule center class clutch complement composite cone constant content control coupling curve cutting cylinder damping degrees depth description device difference direction distance edges ellipsoid encoder epsilon exponent factor fall_off felt_from field field_kind fields file fill flow for force force_limits form frame friction from grid grids gyroid half_space half_width halvings hand_force heart height hole image images in inside interior intersection iso keep kinetic labels lateral lattice layer layers length map_of_grid map_of_image mask mass match material material_grid materials max maxwell memory mesh metaball metaballs name names normal offset on opens_at origin out palpate paper parts passed_before passivity period point port ports priority quadric radii radius ramp rate ratio reach rearm reference region renderer reopens_at resample rotate rounded_box rounding sampler scale scene series shading shaft shaft_way sharp sheet sheets shell sign size slew smooth smooth_difference smooth_intersection smooth_union space speed sphere start static stick_speed stiffening stiffness strength texture thickness threshold time times to tolerance torus transfer transform translate tube union unit units viscosity voxel wall walls wavelength where width with workspace x xx xy xz y yy yz z zz'; else words=NONE; fi
      case $last in
        --completion) words='bash fish zsh' ;;
      esac
      ;;
  esac
  if [[ $word == -* ]]; then words=$options; fi
  case $words in
    FILES) compopt -o default 2>/dev/null; COMPREPLY=() ;;
    NONE) COMPREPLY=() ;;
    *) COMPREPLY=($(compgen -W "$words" -- "$word")) ;;
  esac
}
complete -F _palpate palpate
