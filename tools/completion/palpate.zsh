#compdef palpate
# Made by `palpate help --completion zsh`.
_palpate() {
  local -a verbs=(
    'touch:Move a probe through a scene and feel it'
    'view:Show a scene in the browser while a hand feels it'
    'replay:Feel a record anew, and say whether the same comes out'
    'import:Turn a segmented scan into a scene\: regions, materials, ports'
    'bake:Turn a scene, a mesh or a scan into narrow-band level sets (.vdb)'
    'pack:Put a scene, its grids and what they were made of into one folder'
    'convert:Turn grids into meshes or images, meshes into others, and all into grids'
    'info:Say what a file is\: scene, grid, mesh or scan'
    'check:Say whether meshes, grids and scenes can be touched, and what is wrong with them'
    'query:Value, gradient, region and material at points; or an image'\''s intensity'
    'explain:Show what a scene means\: regions, walls, ports, what can be reached'
    'render:Draw a scene cut open, or in space (.png; turning or replayed\: .webp)'
    'report:Write a page about touches, scenes and benches (.html)'
    'bench:Measure contact (time and error of a tick), a hand in the loop, or how late a loop wakes'
    'accuracy:Compare fields with their grids\: error, time and memory by voxel size'
    'devices:List haptic and input devices, say what bars access to one, test it, calibrate it'
    'doctor:Say whether this machine is fit for a haptic device, and what to do'
    'help:Print help\: all about a verb or a key of scene files, the manual, completion'
  )
  if ((CURRENT == 2)); then _describe verb verbs; return; fi
  case $words[2] in
    touch)
      _arguments \
        '*--path[follow a recorded hand\: header t,x,y,z in s and m, one row a tick; t,device_x,device_y,device_z\: through the scene'\''s device]:value:_files' \
        '*--as-recorded[path\: also rows that are not numbers (nan, inf), and times that do not rise, as a fault left them]' \
        '*--press[press on this point of a surface, hold, and let go]:value:' \
        '*--stroke[stroke in a straight line from A to B and back]:value:' \
        '*--tap[tap on this point of a surface]:value:' \
        '*--insert[go straight from point to point]:value:' \
        '*--normal[press, tap\: outward direction of the surface (default 0,0,1)]:value:' \
        '*--depth[press, tap\: how far below the point (default 2 mm)]:value:' \
        '*--clearance[press, tap\: how far above it the hand starts (default 5 mm)]:value:' \
        '*--speed[press, stroke, insert\: per second (default 50 mm/s; stroke 100 mm/s)]:value:' \
        '*--hold[press, insert\: rest at the far end (default 0.2; insert 0.1)]:value:' \
        '*--repeats[stroke\: there and back N times (default 1)]:value:' \
        '*--frequency[tap\: taps a second (default 4)]:value:' \
        '*--taps[tap\: how many (default 4)]:value:' \
        '*--back[insert\: come back the same way]' \
        '*--renderer[constraint or paper (default\: as the scene says)]:value:(constraint paper)' \
        '*--rate[ticks a second (default 1000)]:value:' \
        '*--device[follow the motion with a simulated device, in a hand that feels the force\: virtual\:NAME, NAME one of excalibur, falcon, touch, touch_x, premium_1_0, premium_1_5, omega_3, delta_3, inverse3; virtual\: may be left out unless NAME is falcon or inverse3. Or let a hand move a device\: falcon, inverse3, hd (OpenHaptics), dhd (Force Dimension), evdev (SpaceMouse, gamepad or mouse, whose force is shown, not felt; evdev\:/dev/input/eventN\: that one). Default\: a hand that follows the motion whatever it feels]:value:' \
        '*--hand[device\: how it is held\: none, relaxed (default) or firm]:value:' \
        '*--delay[device\: samples from a force to when the motors give it (default 0)]:value:' \
        '*--seconds[a device that a hand holds\: for how long (default\: until Ctrl-C)]:value:' \
        '*--realtime[keep to the clock (default\: as fast as the machine goes)]' \
        '*--set[change a content while the hand moves, may be repeated\: syrup.viscosity=9@0.5 (N.s/m, s); also flow, lattice.force, cutting]:value:' \
        '*--serial[falcon\: which one (default\: the first)]:value:' \
        '*--descriptor[falcon\: the file descriptor of its node, which the caller has opened]:value:' \
        '*--firmware[falcon\: image for a device that runs none; checked before a byte is sent]:value:_files' \
        '*--calibration[falcon\: constants, as `palpate devices --calibrate` writes them]:value:_files' \
        '*--library[hd, dhd\: the maker'\''s library (default\: libHD.so or libdhd.so, as the system finds it)]:value:_files' \
        '*--service[inverse3\: its service (default 127.0.0.1\:10001)]:value:' \
        '*--epsilon[so near to the surface a contact point is on it (default 1 um)]:value:' \
        '*--halvings[of the way in which the surface is searched, at most (default 48)]:value:' \
        '*--alpha[of the step back onto the surface (default 1)]:value:' \
        '*--alpha-form[printed, newton, or by_field\: newton where the field is not a distance (default)]:value:(by_field newton printed)' \
        '*--interior[at a wall from within\: wall and content together (default), or the wall alone]:value:(together wall)' \
        '*--passivity[observe the energy that the loop gives to the hand, or control it by damping]:value:(control observe)' \
        '*--hand-force[passivity\: the hand'\''s largest force; no tick then gives more than there is\: 5 (N)]:value:' \
        '*--coupling[a spring and a damper between hand and tool\: springs or any_scene (designed for --device), or STIFFNESS,DAMPING\: 800 N/m,4 N.s/m]:value:' \
        '*--max-force[shorten longer forces to this, direction kept\: 3 (N), 500mN]:value:' \
        '*--slew[let the force grow, in any direction, by no more than this a second\: 100 (N/s); it may drop at once]:value:' \
        '*--ramp[start without force, and reach all of it after this\: 0.2 (s), 200ms]:value:' \
        '*--trace[write one row a tick (SI units)]:value:_files' \
        '*--record[write all that goes into each tick and comes out, for replay and NumPy; beside it FILE.npy.json and FILE.npy.states]:value:_files' \
        '*--states[record\: keep a state every N ticks, from which a replay can begin; 0\: none (default 10000)]:value:' \
        '*--image[draw the scene cut open, with the path and the forces]:value:_files' \
        '*--plot[draw the force over the depth of the hand]:value:_files' \
        '*--write-scene[a mesh, image or grid\: the scene that it is touched as]:value:_files' \
        '*--above[image, grid of densities\: the surface around what is greater]:value:' \
        '*--distances[image of signed distances, negative inside\: the surface where they are 0]' \
        '*--labels[image\: a layer for each of these labels, values or names]:value:' \
        '*--names[image\: table of names of its labels]:value:_files' \
        '*--layer[grid\: this one of a file (default\: every level set)]:value:' \
        '*--voxel[mesh, image\: of the grid that is made, in mm or with a unit (default\: as in a scene)]:value:' \
        '*--units[mesh, or grid that does not say\: what one unit is (default\: mm; glTF and GLB are meters)]:value:' \
        '*--affine[NIfTI\: which form counts (default\: sform, else qform; if both, they must agree); NIfTI, NRRD\: spacings only, axes along R, A, S from 0]:value:(qform sform spacing)' \
        '*--space[which way the axes of a mesh run (default\: as the file says, else RAS), or of a NRRD image that does not say]:value:(LPS RAS)' \
        '*--frame[which volume of a 4-D image, from 0]:value:' \
        '*--series[which DICOM series of a folder that holds several]:value:' \
        '*--resample[a DICOM series whose slices are unevenly spaced, off one line or sheared becomes voxels with right angles, linear between slices]' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    view)
      _arguments \
        '*--device[the simulated device that the page'\''s hand holds (default touch)\: excalibur, falcon, touch, touch_x, premium_1_0, premium_1_5, omega_3, delta_3, inverse3; virtual\:NAME means the same. Or let a hand move a device, and the page watch\: falcon, inverse3, hd, dhd, evdev]:value:' \
        '*--hand[device\: how it is held\: none, relaxed (default) or firm]:value:' \
        '*--delay[device\: samples from a force to when the motors give it (default 0)]:value:' \
        '*--replay[nobody\: go through a record (.npy) or a trace (.csv) of `touch`, tick by tick]:value:_files' \
        '*--seconds[for how long (default\: until Ctrl-C)]:value:' \
        '*--renderer[constraint or paper (default\: as the scene says)]:value:(constraint paper)' \
        '*--serial[falcon\: which one (default\: the first)]:value:' \
        '*--descriptor[falcon\: the file descriptor of its node, which the caller has opened]:value:' \
        '*--firmware[falcon\: image for a device that runs none; checked before a byte is sent]:value:_files' \
        '*--calibration[falcon\: constants, as `palpate devices --calibrate` writes them]:value:_files' \
        '*--library[hd, dhd\: the maker'\''s library (default\: libHD.so or libdhd.so, as the system finds it)]:value:_files' \
        '*--service[inverse3\: its service (default 127.0.0.1\:10001)]:value:' \
        '*--port[at this port of 127.0.0.1 (default\: any that is free)]:value:' \
        '*--no-open[do not open a browser]' \
        '*--record[write all that goes into each tick and comes out, for replay and NumPy; beside it FILE.npy.json and FILE.npy.states]:value:_files' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    replay)
      _arguments \
        '*--scene[feel this scene instead of the record'\''s]:value:_files' \
        '*--renderer[constraint or paper (default\: the one of the record)]:value:(constraint paper)' \
        '*--from[compare from this tick on, and begin at the last state saved before it (default 0)]:value:' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    import)
      _arguments \
        '*-o[where the scene goes (required)]:value:_files' \
        '*--output[where the scene goes (required)]:value:_files' \
        '*--dry-run[write nothing; show regions, and the voxels, memory and time of their grids]' \
        '*--labels[only these labels, each a region of its own (default\: all)]:value:' \
        '*--region[one region of all of these labels, may be repeated]:value:' \
        '*--names[table of names\: `index name`, `value,name`, of Slicer, ITK-SNAP or FreeSurfer (default\: the image'\''s own)]:value:_files' \
        '*--min-island[change pieces and cavities of less than this; the changed image goes to FILE.labels.nii.gz (default\: none, they are only told)]:value:' \
        '*--islands[--min-island\: they become part of what is around (default), or pieces become unlabeled and cavities stay]:value:(drop merge)' \
        '*--image[gray values of the same scan\: CT, MR]:value:_files' \
        '*--skin[--image\: the body is brighter than this; its largest piece, cavities filled (CT\: -300)]:value:' \
        '*--body[or a mask of the body\: what is not 0]:value:_files' \
        '*--tissue[the tissue of a value, a range, a name or a pattern\: "Outer-Table=bone", may be repeated]:value:' \
        '*--tissue-file[lines of the same; --tissue goes before them]:value:_files' \
        '*--codes[the labels are numbers of FreeSurfer'\''s table, of SynthSeg'\''s too, and need no names]:value:(freesurfer)' \
        '*--strict[a label that fits no tissue is an error]' \
        '*--to[the shortest straight way to a region or a label that ports let through, clear of bone, vessels and nerves\: reported, and suggested in the scene; or to a point marked in Slicer (.mrk.json), from a second point if the file has one]:value:' \
        '*--burr-hole[--to\: drill a round hole through the bone on the shortest way, in mm or with a unit; the changed image goes to FILE.labels.nii.gz]:value:' \
        '*--way[--to\: write the way as a line that Slicer loads]:value:_files' \
        '*--hounsfield[--image is a CT in Hounsfield units\: stiffness varies with it, where the table of tissues says how]' \
        '*--materials[table of tissues (default\: the project'\''s data/materials/tissues.yaml)]:value:_files' \
        '*--voxel[voxel size of the grids, in mm or with a unit (default\: of the same volume as the scan'\''s)]:value:' \
        '*--priority[of masks that overlap the first named here has the voxel (default\: the smallest)]:value:' \
        '*--affine[NIfTI\: which form counts (default\: sform, else qform; if both, they must agree); NIfTI, NRRD\: spacings only, axes along R, A, S from 0]:value:(qform sform spacing)' \
        '*--space[which way the axes of a NRRD image run that does not say]:value:(LPS RAS)' \
        '*--frame[which volume of a 4-D image, from 0]:value:' \
        '*--series[which DICOM series of a folder that holds several]:value:' \
        '*--resample[a DICOM series whose slices are unevenly spaced, off one line or sheared becomes voxels with right angles, linear between slices]' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    bake)
      _arguments \
        '*-o[where the grids go (required)]:value:_files' \
        '*--output[where the grids go (required)]:value:_files' \
        '*--parts[scene\: keep its edges. Grids of its smooth parts only, and here the scene that puts them together with the rest]:value:_files' \
        '*--voxel[voxel size, in the input'\''s unit or with a unit\: 0.5mm (default\: that of an image or grid; else 1/128 of the longest side)]:value:' \
        '*--half-width[width of the narrow band on each side of the surface (default 6)]:value:' \
        '*--max-memory[refuse, before it is taken, what needs more\: 500MB, 2GB (default\: 80 % of the machine'\''s)]:value:' \
        '*--layer[scene, grid\: only this layer, may be repeated; mesh, --above\: what to call it]:value:' \
        '*--units[what one unit of the mesh is\: mm (default), cm, m, um, in]:value:' \
        '*--sign[what is inside\: where both agree, else refuse (default); by winding number, holes closed by flat lids; what a flood from outside does not reach; or nothing, distances without sign]:value:(flood unsigned vote winding)' \
        '*--shell[not a solid but a wall of this thickness along the triangles]:value:' \
        '*--smooth[facets that meet at less than this angle become one smooth surface]:value:' \
        '*--affine[NIfTI\: which form counts (default\: sform, else qform; if both, they must agree); NIfTI, NRRD\: spacings only, axes along R, A, S from 0]:value:(qform sform spacing)' \
        '*--space[which way the axes of a mesh run (default\: as the file says, else RAS), or of a NRRD image that does not say]:value:(LPS RAS)' \
        '*--frame[which volume of a 4-D image, from 0]:value:' \
        '*--series[which DICOM series of a folder that holds several]:value:' \
        '*--resample[a DICOM series whose slices are unevenly spaced, off one line or sheared becomes voxels with right angles, linear between slices]' \
        '*--above[the surface around all voxels greater than this]:value:' \
        '*--distances[the voxels are signed distances, negative inside\: the surface where they are zero]' \
        '*--keep[--above\: which pieces (default largest)]:value:(all largest)' \
        '*--fill[--above\: close enclosed cavities]' \
        '*--labels[one grid for each of these labels\: values, ranges 5-28, names, or patterns such as '\''lung*'\'']:value:' \
        '*--names[table of names\: `index name`, `value,name`, of Slicer, ITK-SNAP or FreeSurfer (default\: the image'\''s own)]:value:_files' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    pack)
      _arguments \
        '*-o[the bundle (required)]:value:' \
        '*--output[the bundle (required)]:value:' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    convert)
      _arguments \
        '*-o[.stl .obj .ply .glb, .nii .nii.gz or .vdb (required)]:value:_files' \
        '*--output[.stl .obj .ply .glb, .nii .nii.gz or .vdb (required)]:value:_files' \
        '*--to-units[what one unit of the mesh is to be\: mm, cm, m, um, in (default\: as in the input)]:value:' \
        '*--voxel[voxel size, in the input'\''s unit or with a unit\: 0.5mm (default\: that of an image or grid; else 1/128 of the longest side)]:value:' \
        '*--half-width[width of the narrow band on each side of the surface (default 6)]:value:' \
        '*--max-memory[refuse, before it is taken, what needs more\: 500MB, 2GB (default\: 80 % of the machine'\''s)]:value:' \
        '*--layer[scene, grid\: only this layer, may be repeated; mesh, --above\: what to call it]:value:' \
        '*--units[what one unit of the mesh is\: mm (default), cm, m, um, in]:value:' \
        '*--sign[what is inside\: where both agree, else refuse (default); by winding number, holes closed by flat lids; what a flood from outside does not reach; or nothing, distances without sign]:value:(flood unsigned vote winding)' \
        '*--shell[not a solid but a wall of this thickness along the triangles]:value:' \
        '*--smooth[facets that meet at less than this angle become one smooth surface]:value:' \
        '*--affine[NIfTI\: which form counts (default\: sform, else qform; if both, they must agree); NIfTI, NRRD\: spacings only, axes along R, A, S from 0]:value:(qform sform spacing)' \
        '*--space[which way the axes of a mesh run (default\: as the file says, else RAS), or of a NRRD image that does not say]:value:(LPS RAS)' \
        '*--frame[which volume of a 4-D image, from 0]:value:' \
        '*--series[which DICOM series of a folder that holds several]:value:' \
        '*--resample[a DICOM series whose slices are unevenly spaced, off one line or sheared becomes voxels with right angles, linear between slices]' \
        '*--above[the surface around all voxels greater than this]:value:' \
        '*--distances[the voxels are signed distances, negative inside\: the surface where they are zero]' \
        '*--keep[--above\: which pieces (default largest)]:value:(all largest)' \
        '*--fill[--above\: close enclosed cavities]' \
        '*--labels[one grid for each of these labels\: values, ranges 5-28, names, or patterns such as '\''lung*'\'']:value:' \
        '*--names[table of names\: `index name`, `value,name`, of Slicer, ITK-SNAP or FreeSurfer (default\: the image'\''s own)]:value:_files' \
        '*--level-set[a grid that does not say its class holds signed distances, negative inside]' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    info)
      _arguments \
        '*--units[what one unit of a mesh is\: mm (default), cm, m, um, in]:value:' \
        '*--names[image\: table of names of its labels]:value:_files' \
        '*--affine[NIfTI\: which form counts (default\: sform, else qform; if both, they must agree); NIfTI, NRRD\: spacings only, axes along R, A, S from 0]:value:(qform sform spacing)' \
        '*--space[which way the axes of a mesh run (default\: as the file says, else RAS), or of a NRRD image that does not say]:value:(LPS RAS)' \
        '*--frame[which volume of a 4-D image, from 0]:value:' \
        '*--series[which DICOM series of a folder that holds several]:value:' \
        '*--resample[a DICOM series whose slices are unevenly spaced, off one line or sheared becomes voxels with right angles, linear between slices]' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    check)
      _arguments \
        '*--units[what one unit is, of a mesh or of a grid that does not say\: mm (a mesh'\''s default), cm, m, um, in]:value:' \
        '*--space[mesh\: which way its axes run (default\: as the file says, else RAS); places are printed in RAS]:value:(LPS RAS)' \
        '*--voxel[mesh\: voxel size of the bake that is tried (default\: 1/128 of the longest side)]:value:' \
        '*--layer[grid\: only this one of the file]:value:' \
        '*--level-set[a grid that does not say its class holds signed distances, negative inside]' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    query)
      _arguments \
        '*--field[scene\: this field or layer only]:value:' \
        '*--at[at these points]:value:' \
        '*--points[at the points of a file with the header x,y,z]:value:_files' \
        '*--affine[NIfTI\: which form counts (default\: sform, else qform; if both, they must agree); NIfTI, NRRD\: spacings only, axes along R, A, S from 0]:value:(qform sform spacing)' \
        '*--space[which way the axes of a NRRD image run that does not say]:value:(LPS RAS)' \
        '*--frame[which volume of a 4-D image, from 0]:value:' \
        '*--series[which DICOM series of a folder that holds several]:value:' \
        '*--resample[a DICOM series whose slices are unevenly spaced, off one line or sheared becomes voxels with right angles, linear between slices]' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    explain)
      _arguments \
        '*--measure[make all of it, and what is needed, and tell memory and time]' \
        '*--device[list what is felt beside what this device can hold, and what cures what it cannot\: excalibur, falcon, touch, touch_x, premium_1_0, premium_1_5, omega_3, delta_3, inverse3 (virtual\:NAME means the same)]:value:' \
        '*--hand[device\: how it is held\: none, relaxed (default) or firm]:value:' \
        '*--delay[device\: samples from a force to when the motors give it (default 0)]:value:' \
        '*--rate[device\: ticks a second (default 1000)]:value:' \
        '*--svg[draw the table of transitions\: regions, and the ports between them]:value:_files' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    render)
      _arguments \
        '*-o[the picture (required); with --turn or --replay FILE.webp, or FILE.png for frames FILE-0001.png and so on]:value:_files' \
        '*--output[the picture (required); with --turn or --replay FILE.webp, or FILE.png for frames FILE-0001.png and so on]:value:_files' \
        '*--size[in pixels (default 1600x1000)]:value:' \
        '*--plane[across an axis\: x=12 (the scene'\''s unit)]:value:' \
        '*--cut[any plane\: a point and a normal; looked at against it]:value:' \
        '*--trace[the path and the forces of a `touch --trace`]:value:_files' \
        '*--image[gray values of this scan, or of this image of the scene (default\: the scene'\''s first that has no names)]:value:_files' \
        '*--iso[lines of equal distance from the nearest layer'\''s surface, so far apart\: 5 (the scene'\''s unit)]:value:' \
        '*--forces[arrows where it is cut, N along its longer side\: the force on a hand that was led there from the nearest place outside and rests]:value:' \
        '*--view[from where\: corner, front, back, left, right, top, bottom (of the patient in a scan), +x, -x, +y, -y, +z, -z, or X,Y,Z at the viewer]:value:' \
        '*--around[view\: look at this point, and so far around it (the scene'\''s unit; default\: all)]:value:' \
        '*--opacity[view\: see through this layer\: skin=0.3; may be repeated]:value:' \
        '*--slice[view\: a slice with its gray values that stands in the scene; may be repeated]:value:' \
        '*--turn[view\: turn once about z, so many pictures, 20 a second]:value:' \
        '*--replay[view\: the hand and the force on their way along the trace, so many pictures]:value:' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    report)
      _arguments \
        '*-o[the page (required)]:value:_files' \
        '*--output[the page (required)]:value:_files' \
        '*--device[list what is felt beside what this device can hold, as palpate explain does]:value:' \
        '*--hand[device\: how it is held\: none, relaxed (default) or firm]:value:' \
        '*--delay[device\: samples from a force to when the motors give it (default 0)]:value:' \
        '*--rate[device\: ticks a second (default 1000)]:value:' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    bench)
      _arguments \
        '*--scene[only this scene, may be repeated (default\: all)]:value:' \
        '*--renderer[only this renderer\: constraint or paper, for stability also a rival (default\: all)]:value:' \
        '*--device[stability\: only this device, may be repeated (default\: falcon and touch)]:value:' \
        '*--full[stability\: where nothing else is said all scenes, four devices, 1, 4 and 10 kHz (hours)]' \
        '*--repeat[runs, of which the shortest time counts (default 10)]:value:' \
        '*--paced[ticks that are timed one a millisecond, the loop asleep in between (default 2000)]:value:' \
        '*--cold[ticks that are timed after other data went through the caches (default 30)]:value:' \
        '*--rate[servo and stability\: a rate, may be repeated (default 1000, servo 4000 too)]:value:' \
        '*--seconds[for how long at each rate (default 5)]:value:' \
        '*--load[threads that compute meanwhile (default\: none, and then as many as there are cores)]:value:' \
        '*--csv[the table, one row for each scene and renderer]:value:_files' \
        '*--svg[a plot of error against time; for stability of stiffness over rate]:value:_files' \
        '*--curvature-svg[stability\: a plot of stiffness over curvature times depth]:value:_files' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    accuracy)
      _arguments \
        '*--field[only this layer or field, may be repeated (default\: every layer)]:value:' \
        '*--voxel[a voxel size, in the scene'\''s unit or with a unit\: 0.5mm; may be repeated]:value:' \
        '*--ladder[voxel sizes (default\: the longest side by 32, 64, 128 and 256)]:value:' \
        '*--sampler[only this one, may be repeated\: cubic, trilinear, accessor (default\: all)]:value:(accessor cubic trilinear)' \
        '*--points[random points to compare at (default 100000)]:value:' \
        '*--band[how far from the surface they are, at most (default 1 voxel)]:value:' \
        '*--repeat[timed runs, of which the shortest counts; three cold queries for each (default 10)]:value:' \
        '*--csv[the table, one row for each field, voxel size and sampler]:value:_files' \
        '*--svg[plots of error against time and against memory]:value:_files' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--no-cache[make all grids anew, and keep none for the next time]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    devices)
      _arguments \
        '*--test[open falcon, inverse3, dhd, hd, evdev or evdev\:/dev/input/eventN, write zero force for a while, and tell what it says]:value:' \
        '*--calibrate[falcon\: the origin where the grip is held; the constants go to FILE]:value:_files' \
        '*--states[print the table of states that every device goes through]' \
        '*--seconds[--test, --calibrate\: for how long (default 10)]:value:' \
        '*--serial[falcon\: which one (default\: the first)]:value:' \
        '*--descriptor[falcon\: the file descriptor of its node, which the caller has opened]:value:' \
        '*--firmware[falcon\: image for a device that runs none; checked before a byte is sent]:value:_files' \
        '*--calibration[falcon\: constants, as `palpate devices --calibrate` writes them]:value:_files' \
        '*--library[hd, dhd\: the maker'\''s library (default\: libHD.so or libdhd.so, as the system finds it)]:value:_files' \
        '*--service[inverse3\: its service (default 127.0.0.1\:10001)]:value:' \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*--force[replace existing output files]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    doctor)
      _arguments \
        '*--json[print one JSON object instead of text]' \
        '*--quiet[no notes and no progress on stderr]' \
        '*-h[print this]' \
        '*--help[print this]' \
        '*:file:_files'
      ;;
    help)
      if ((CURRENT == 3)); then compadd touch view replay import bake pack convert info check query explain render report bench accuracy devices doctor help scene; fi
      if ((CURRENT == 4)) && [[ $words[3] == scene ]]; then compadd above affine after alpha amplitude axis back baked balls base below between box capsule center class clutch complement composite cone constant content control coupling curve cutting cylinder damping degrees depth description device difference direction distance edges ellipsoid encoder epsilon exponent factor fall_off felt_from field field_kind fields file fill flow for force force_limits form frame friction from grid grids gyroid half_space half_width halvings hand_force heart height hole image images in inside interior intersection iso keep kinetic labels lateral lattice layer layers length map_of_grid map_of_image mask mass match material material_grid materials max maxwell memory mesh metaball metaballs name names normal offset on opens_at origin out palpate paper parts passed_before passivity period point port ports priority quadric radii radius ramp rate ratio reach rearm reference region renderer reopens_at resample rotate rounded_box rounding sampler scale scene series shading shaft shaft_way sharp sheet sheets shell sign size slew smooth smooth_difference smooth_intersection smooth_union space speed sphere start static stick_speed stiffening stiffness strength texture thickness threshold time times to tolerance torus transfer transform translate tube union unit units viscosity voxel wall walls wavelength where width with workspace x xx xy xz y yy yz z zz; fi
      _arguments \
        '*--markdown[everything, as the reference in tools/README.md; of a map of scene files the table of its keys]' \
        '*--schema[scene\: the JSON Schema of scene files]' \
        '*--man[the manual page palpate(1)]' \
        '*--completion[what completes words in bash, zsh or fish]:value:(bash fish zsh)' \
        '*-h[print this]' \
        '*--help[print this]'
      ;;
  esac
}
_palpate "$@"
