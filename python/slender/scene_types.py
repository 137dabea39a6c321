"""What a scene may say, for type checkers: `scene: slender.scene_types.Scene = {..}`. docs/scene.md says what it means.

Made by python/make_scene_types.py from `slender schema`; do not edit. Which keys are needed, and which go together, is
for slender.Scene to say."""
from __future__ import annotations

from typing import Any, Literal, Mapping, Sequence as Rows, TypedDict, Union

from numpy.typing import NDArray

Number = Union[float, str]  # or text with a unit, "1 mm"
Numbers = Union[Rows[Number], NDArray[Any]]
Table = Union[Rows[Numbers], NDArray[Any]]


Shell = TypedDict("Shell", {
    "mesh": "Mesh", "pose": "Pose", "velocity": "Velocity", "thickness": "Thickness", "young": "Young",
    "poisson": "float", "density": "Density", "material": "Literal['st_venant_kirchhoff', 'neo_hookean']",
    "bending": "Literal['midedge', 'hinge']", "fold": "Fold", "magnetization": "Magnetization",
    "coercivity": "Number", "damping": "Number", "gravity": "Numbers",
}, total=False)

MeshKeys = TypedDict("MeshKeys", {
    "file": "str", "shape": "Literal['sheet', 'strip', 'hexagram', 'disc', 'kirigami']",
    "size": "Union[Number, Numbers]", "cells": "Union[int, Numbers]", "n": "int", "divisions": "int", "false": "int",
    "pattern": "Literal['right', 'alternate', 'crossed']", "scale": "float", "weld": "Number",
}, total=False)

PoseKeys = TypedDict("PoseKeys", {
    "file": "str", "formula": "Numbers", "scale": "float", "where": "Mapping[str, Where]",
}, total=False)

WhereKeys = TypedDict("WhereKeys", {
    "formula": "Number",
}, total=False)

VelocityKeys = TypedDict("VelocityKeys", {
    "value": "Numbers", "formula": "Numbers", "file": "str", "where": "Mapping[str, Where]",
}, total=False)

ThicknessKeys = TypedDict("ThicknessKeys", {
    "value": "Number", "file": "str", "formula": "Number", "groups": "Mapping[str, ThicknessOfAGroup]",
    "other": "Number", "where": "Mapping[str, Where]",
}, total=False)

ThicknessOfAGroupKeys = TypedDict("ThicknessOfAGroupKeys", {
    "value": "Number",
}, total=False)

YoungKeys = TypedDict("YoungKeys", {
    "value": "Number", "file": "str", "formula": "Number", "groups": "Mapping[str, YoungOfAGroup]", "other": "Number",
    "where": "Mapping[str, Where]",
}, total=False)

YoungOfAGroupKeys = TypedDict("YoungOfAGroupKeys", {
    "value": "Number",
}, total=False)

DensityKeys = TypedDict("DensityKeys", {
    "value": "Number", "file": "str", "formula": "Number", "groups": "Mapping[str, DensityOfAGroup]",
    "other": "Number", "where": "Mapping[str, Where]",
}, total=False)

DensityOfAGroupKeys = TypedDict("DensityOfAGroupKeys", {
    "value": "Number",
}, total=False)

FoldKeys = TypedDict("FoldKeys", {
    "value": "float", "file": "str", "formula": "Number", "groups": "Mapping[str, FoldOfAGroup]", "other": "float",
    "where": "Mapping[str, Where]",
}, total=False)

FoldOfAGroupKeys = TypedDict("FoldOfAGroupKeys", {
    "value": "float",
}, total=False)

MagnetizationKeys = TypedDict("MagnetizationKeys", {
    "value": "Numbers", "remanence": "Numbers", "file": "str", "formula": "Numbers",
    "groups": "Mapping[str, MagnetizationOfAGroup]", "other": "Numbers", "where": "Mapping[str, Where]",
}, total=False)

MagnetizationOfAGroupKeys = TypedDict("MagnetizationOfAGroupKeys", {
    "value": "Numbers", "remanence": "Numbers",
}, total=False)

Rod = TypedDict("Rod", {
    "model": "Literal['kirchhoff', 'cosserat']", "curve": "CurveOfARod", "natural_strain": "NaturalStrain",
    "poses": "Rows[Poses]", "motion": "MotionOfARod", "length": "Number", "clamp": "Clamp",
    "hold": "Literal['clamped', 'pinned']", "end": "End", "elements": "int", "radius": "LengthAlongARod",
    "ellipse": "Union[Number, Numbers]", "section": "SectionOfARod", "young": "YoungAlongARod", "poisson": "float",
    "density": "Number", "gravity": "Numbers", "frame": "Frame", "frames": "Rows[Frame]", "bishop_normal": "Numbers",
    "loads": "Rows[LoadsOfARod]", "magnetization": "Magnetization", "coercivity": "Number", "damping": "Number",
    "start": "Literal['natural', 'curve']", "velocity": "Velocity", "solver": "Literal['newton', 'pbd']",
    "pbd": "Pbd",
}, total=False)

CurveOfARod = TypedDict("CurveOfARod", {
    "formula": "Numbers", "file": "str", "parameter": "Number", "range": "Union[float, Numbers]", "strands": "int",
    "where": "Mapping[str, Where]", "scale": "float", "noise": "Noise",
}, total=False)

NoiseKeys = TypedDict("NoiseKeys", {
    "mode": "Literal['auto']", "value": "Number",
}, total=False)

NaturalStrainKeys = TypedDict("NaturalStrainKeys", {
    "value": "Numbers", "formula": "Numbers", "file": "str", "where": "Mapping[str, Where]",
}, total=False)

Poses = TypedDict("Poses", {
    "file": "str", "frame": "Table", "noise": "Noise",
}, total=False)

MotionOfARod = TypedDict("MotionOfARod", {
    "frames": "Rows[FramesOfAMotion]", "result": "str", "difference": "Literal['central', 'backward']",
}, total=False)

FramesOfAMotion = TypedDict("FramesOfAMotion", {
    "file": "str", "time": "Number", "noise": "Noise",
}, total=False)

Clamp = TypedDict("Clamp", {
    "position": "Numbers", "frame": "Table", "move": "Path", "turn": "Path",
}, total=False)

PathKeys = TypedDict("PathKeys", {
    "formula": "Numbers", "file": "str",
}, total=False)

End = TypedDict("End", {
    "position": "Numbers", "hold": "Literal['clamped', 'pinned']", "frame": "Table", "move": "Path", "turn": "Path",
    "force": "Numbers", "choose": "Literal['straightest', 'least_stressed']", "couple": "Numbers",
}, total=False)

LengthAlongARodKeys = TypedDict("LengthAlongARodKeys", {
    "value": "Number", "formula": "Number", "file": "str", "where": "Mapping[str, Where]",
}, total=False)

SectionOfARod = TypedDict("SectionOfARod", {
    "width": "LengthAlongARod", "height": "LengthAlongARod", "area": "AreaAlongARod", "I1": "MomentOfAreaAlongARod",
    "I2": "MomentOfAreaAlongARod", "J": "MomentOfAreaAlongARod", "kappa": "Numbers", "contact_radius": "Number",
}, total=False)

AreaAlongARodKeys = TypedDict("AreaAlongARodKeys", {
    "value": "Number", "formula": "Number", "file": "str", "where": "Mapping[str, Where]",
}, total=False)

MomentOfAreaAlongARodKeys = TypedDict("MomentOfAreaAlongARodKeys", {
    "value": "Number", "formula": "Number", "file": "str", "where": "Mapping[str, Where]",
}, total=False)

YoungAlongARodKeys = TypedDict("YoungAlongARodKeys", {
    "value": "Number", "formula": "Number", "file": "str", "where": "Mapping[str, Where]",
}, total=False)

FrameKeys = TypedDict("FrameKeys", {
    "kind": "Literal['frenet', 'bishop']", "formula": "Number", "from": "Literal['frenet', 'bishop']", "file": "str",
}, total=False)

LoadsOfARod = TypedDict("LoadsOfARod", {
    "point": "PointOfALoad", "line": "LineLoadOfARod", "potential": "Number", "force": "ForceOnARod",
    "couple": "CoupleOnARod", "where": "Mapping[str, Where]",
}, total=False)

PointOfALoadKeys = TypedDict("PointOfALoadKeys", {
    "end": "Literal['end']", "value": "Number",
}, total=False)

LineLoadOfARodKeys = TypedDict("LineLoadOfARodKeys", {
    "value": "Numbers", "formula": "Numbers", "where": "Mapping[str, Where]",
}, total=False)

ForceOnARodKeys = TypedDict("ForceOnARodKeys", {
    "value": "Numbers", "formula": "Numbers", "where": "Mapping[str, Where]",
}, total=False)

CoupleOnARodKeys = TypedDict("CoupleOnARodKeys", {
    "value": "Numbers", "formula": "Numbers", "where": "Mapping[str, Where]",
}, total=False)

Pbd = TypedDict("Pbd", {
    "substeps": "int", "sweeps": "int",
}, total=False)

Solid = TypedDict("Solid", {
    "mesh": "MeshOfASolid", "order": "int",
    "material": "Literal['neo_hookean', 'neo_hookean_log', 'st_venant_kirchhoff']", "young": "Young",
    "poisson": "float", "density": "Number", "averaging": "float", "skin": "Skin", "magnetization": "Magnetization",
    "coercivity": "Number", "pose": "Pose", "velocity": "Velocity", "damping": "Number", "gravity": "Numbers",
}, total=False)

MeshOfASolidKeys = TypedDict("MeshOfASolidKeys", {
    "file": "str", "shape": "Literal['box', 'plate', 'hand', 'heart', 'starfish']", "extrude": "Mesh",
    "surface": "str", "size": "Union[Number, Numbers]", "cells": "Union[int, Numbers]", "n": "int",
    "divisions": "int", "false": "int", "pattern": "Literal['right', 'alternate', 'crossed']", "thickness": "Number",
    "layers": "int", "scale": "float",
}, total=False)

Skin = TypedDict("Skin", {
    "thickness": "Number", "magnetization": "Magnetization", "young": "Young", "poisson": "float",
    "material": "Literal['st_venant_kirchhoff', 'neo_hookean']", "on": "PlaceOfASkin", "region": "PlaceOfASkin",
    "true": "PlaceOfASkin",
}, total=False)

PlaceOfASkinKeys = TypedDict("PlaceOfASkinKeys", {
    "group": "Number",
}, total=False)

Spline = TypedDict("Spline", {
    "image": "str", "density": "DensityOfADrawing", "tone": "Tone", "page": "Page", "pen": "Number",
    "pens": "Rows[Pens]", "paper": "Number", "separation": "Separation", "regions": "Rows[Regions]", "cross": "Cross",
    "contours": "Contours", "direction": "Direction", "start": "StartOfADrawing", "energies": "Energies",
    "potential": "Potential", "flow": "Flow", "pair": "Pair",
    "method": "Literal['auto', 'newton', 'gradient', 'monte_carlo', 'dynamics']", "iterations": "int",
    "tolerance": "float", "draft": "bool", "rounds": "int", "rest": "float", "monte_carlo": "MonteCarlo",
    "dynamics": "Dynamics", "seed": "int", "order": "Literal['shortest', 'as_made']", "plotter": "Plotter",
}, total=False)

DensityOfADrawingKeys = TypedDict("DensityOfADrawingKeys", {
    "formula": "Number", "where": "Mapping[str, Where]",
}, total=False)

Tone = TypedDict("Tone", {
    "crop": "Numbers", "fit": "Literal['contain', 'cover']", "invert": "bool", "black": "float", "white": "float",
    "gamma": "float", "curve": "Table", "density": "float",
}, total=False)

Page = TypedDict("Page", {
    "size": "SizeOfAPage", "margin": "Number",
}, total=False)

SizeOfAPageKeys = TypedDict("SizeOfAPageKeys", {
    "sides": "Union[Number, Numbers]", "name": "Number",
}, total=False)

PensKeys = TypedDict("PensKeys", {
    "name": "Number", "color": "Number", "opaque": "bool", "width": "Number", "from": "float", "turn": "Number",
}, total=False)

SeparationKeys = TypedDict("SeparationKeys", {
    "kind": "Literal['cmyk', 'tones', 'match']", "black": "float", "intent": "Literal['relative', 'absolute']",
}, total=False)

Regions = TypedDict("Regions", {
    "svg": "str", "mask": "str", "fit": "Literal['contain', 'paper']", "invert": "bool", "direction": "Direction",
    "pen": "Number",
}, total=False)

DirectionKeys = TypedDict("DirectionKeys", {
    "image": "Literal['structure_tensor']", "angle": "Number", "formula": "Numbers", "file": "str", "turn": "Number",
    "detail": "Number", "smooth": "Number", "spread": "Number", "where": "Mapping[str, Where]",
}, total=False)

Cross = TypedDict("Cross", {
    "angle": "Number", "from": "Union[float, Numbers]",
}, total=False)

ContoursKeys = TypedDict("ContoursKeys", {
    "kind": "Literal['edges', 'outlines']", "levels": "Union[float, Numbers]", "contrast": "float",
    "detail": "Number", "shortest": "Number", "width": "Number", "color": "Number", "opaque": "bool",
}, total=False)

StartOfADrawingKeys = TypedDict("StartOfADrawingKeys", {
    "kind": "Literal['streamlines', 'random']", "file": "str", "separation": "float", "ink": "float",
    "longest": "Number", "segments": "int",
}, total=False)

Energies = TypedDict("Energies", {
    "tone": "float", "strain": "float", "bend": "float", "align": "float", "wall": "float", "outline": "float",
    "stretch": "float", "curvature": "float", "potential": "float", "flow": "float", "boundary": "float",
    "pair": "float", "length": "float",
}, total=False)

PotentialKeys = TypedDict("PotentialKeys", {
    "formula": "Number", "where": "Mapping[str, Where]",
}, total=False)

FlowKeys = TypedDict("FlowKeys", {
    "formula": "Numbers", "where": "Mapping[str, Where]",
}, total=False)

Pair = TypedDict("Pair", {
    "kernel": "Literal['wendland', 'triweight', 'coulomb']", "radius": "float",
}, total=False)

MonteCarlo = TypedDict("MonteCarlo", {
    "temperatures": "int", "sweeps": "int", "first": "float", "last": "float",
}, total=False)

Dynamics = TypedDict("Dynamics", {
    "step": "float", "steps": "int", "damping": "float",
}, total=False)

Plotter = TypedDict("Plotter", {
    "down": "Number", "up": "Number", "lift": "Number", "at_most": "Number", "z": "ZAxis", "servo": "Servo",
    "profile": "str",
}, total=False)

ZAxis = TypedDict("ZAxis", {
    "up": "Number", "down": "Number", "speed": "Number",
}, total=False)

Servo = TypedDict("Servo", {
    "up": "Number", "down": "Number", "pause": "Literal['seconds', 'milliseconds']",
}, total=False)

FluxDensityKeys = TypedDict("FluxDensityKeys", {
    "name": "Number", "value": "Numbers", "uniform": "Numbers", "formula": "Numbers", "file": "str",
    "dipole": "Dipole", "magnet": "Magnet", "coil": "Coil", "map": "Map", "where": "Mapping[str, Where]",
    "move": "Path", "turn": "Path",
}, total=False)

Dipole = TypedDict("Dipole", {
    "at": "Numbers", "moment": "Numbers",
}, total=False)

Magnet = TypedDict("Magnet", {
    "at": "Numbers", "remanence": "Numbers", "size": "Numbers", "radius": "Number", "volume": "Number",
    "length": "Number", "axis": "Numbers",
}, total=False)

Coil = TypedDict("Coil", {
    "at": "Numbers", "axis": "Numbers", "radius": "Number", "size": "Numbers", "length": "Number",
    "current": "Number", "turns": "float",
}, total=False)

Map = TypedDict("Map", {
    "file": "str", "scale": "float",
}, total=False)

FixKeys = TypedDict("FixKeys", {
    "vertices": "Union[int, Numbers]", "box": "Table", "ball": "Ball", "group": "Number", "boundary": "bool",
    "axes": "Number", "clamp": "bool", "move": "Numbers",
}, total=False)

Ball = TypedDict("Ball", {
    "center": "Numbers", "radius": "Number",
}, total=False)

Loads = TypedDict("Loads", {
    "force": "Numbers", "line": "Numbers", "area": "Numbers", "couple": "Numbers", "on": "Selection",
    "region": "Selection", "true": "Selection", "point": "PointOfALoad",
}, total=False)

SelectionKeys = TypedDict("SelectionKeys", {
    "vertices": "Union[int, Numbers]", "box": "Table", "ball": "Ball", "group": "Number", "boundary": "bool",
}, total=False)

TargetKeys = TypedDict("TargetKeys", {
    "file": "str", "height_map": "str", "strokes": "Table", "formula": "Numbers", "height": "Number",
    "width": "Number", "cloud": "str", "scale": "float", "blend": "Number", "where": "Mapping[str, Where]",
    "axes": "Number", "weight": "float", "on": "Selection", "region": "Selection", "true": "Selection",
}, total=False)

Obstacles = TypedDict("Obstacles", {
    "name": "Number", "plane": "Plane", "sphere": "Sphere", "cylinder": "Cylinder", "box": "Box",
    "height_field": "HeightField", "tube": "Tube", "mesh": "MeshOfAnObstacle", "friction": "float", "move": "Path",
    "turn": "Path",
}, total=False)

Plane = TypedDict("Plane", {
    "point": "Numbers", "normal": "Numbers",
}, total=False)

Sphere = TypedDict("Sphere", {
    "center": "Numbers", "radius": "Number", "inside": "bool",
}, total=False)

Cylinder = TypedDict("Cylinder", {
    "point": "Numbers", "axis": "Numbers", "radius": "Number", "inside": "bool",
}, total=False)

Box = TypedDict("Box", {
    "center": "Numbers", "half": "Numbers", "rounding": "Number",
}, total=False)

HeightField = TypedDict("HeightField", {
    "formula": "Number", "image": "str", "height": "Number", "range": "Table", "cells": "Numbers",
    "where": "Mapping[str, Where]",
}, total=False)

Tube = TypedDict("Tube", {
    "axis": "Literal['x', 'y', 'z']", "radius": "Number", "center": "Numbers", "range": "Numbers", "cells": "int",
}, total=False)

MeshOfAnObstacleKeys = TypedDict("MeshOfAnObstacleKeys", {
    "file": "str", "scale": "float", "cell": "Number",
}, total=False)

Contact = TypedDict("Contact", {
    "friction": "float", "self": "SelfContact", "stiffness": "StiffnessOfContact", "offset": "OffsetOfContact",
    "slip_speed": "Number", "coupling": "Literal['lagged', 'implicit']",
}, total=False)

SelfContactKeys = TypedDict("SelfContactKeys", {
    "enabled": "bool", "distance": "Number", "stiffness": "Number",
}, total=False)

StiffnessOfContactKeys = TypedDict("StiffnessOfContactKeys", {
    "mode": "Literal['auto']", "value": "Number",
}, total=False)

OffsetOfContactKeys = TypedDict("OffsetOfContactKeys", {
    "mode": "Literal['auto']", "value": "Number",
}, total=False)

Water = TypedDict("Water", {
    "density": "Number", "velocity": "VelocityOfWater", "sides": "Literal['two', 'outer']", "viscosity": "Number",
}, total=False)

VelocityOfWaterKeys = TypedDict("VelocityOfWaterKeys", {
    "value": "Numbers", "formula": "Numbers", "where": "Mapping[str, Where]",
}, total=False)

Cases = TypedDict("Cases", {
    "name": "Number", "weight": "float", "flux_density": "Union[FluxDensity, Rows[FluxDensity]]",
    "loads": "Rows[Loads]", "gravity": "Numbers", "target": "Union[Target, Rows[Target]]",
}, total=False)

SequenceKeys = TypedDict("SequenceKeys", {
    "stages": "Rows[Stages]", "flux_density": "RangeOfFluxDensities", "loads": "RangeOfLoads",
    "gravity": "RangeOfGravity", "time": "RangeOfTimes",
}, total=False)

Stages = TypedDict("Stages", {
    "flux_density": "Union[FluxDensity, Rows[FluxDensity]]", "loads": "Rows[Loads]", "gravity": "Numbers",
    "time": "Number",
}, total=False)

RangeOfFluxDensities = TypedDict("RangeOfFluxDensities", {
    "from": "Union[FluxDensity, Rows[FluxDensity]]", "to": "Union[FluxDensity, Rows[FluxDensity]]", "count": "int",
}, total=False)

RangeOfLoads = TypedDict("RangeOfLoads", {
    "from": "Union[Loads, Rows[Loads]]", "to": "Union[Loads, Rows[Loads]]", "count": "int",
}, total=False)

RangeOfGravity = TypedDict("RangeOfGravity", {
    "from": "Numbers", "to": "Numbers", "count": "int",
}, total=False)

RangeOfTimes = TypedDict("RangeOfTimes", {
    "from": "Number", "to": "Number", "count": "int",
}, total=False)

Probes = TypedDict("Probes", {
    "vertex": "Number", "group": "Number", "mass_center": "bool", "height": "Number", "distance": "Numbers",
    "angle": "Numbers", "axis": "Numbers", "force": "ForceOfAProbe", "couple": "int",
}, total=False)

ForceOfAProbeKeys = TypedDict("ForceOfAProbeKeys", {
    "group": "Number", "fix": "int", "obstacle": "Number",
}, total=False)

Design = TypedDict("Design", {
    "unknowns": "Unknowns", "objectives": "Rows[Objectives]", "optimizer": "Literal['mma', 'lbfgs', 'gauss_newton']",
    "iterations": "int", "tolerance": "float", "seed": "int",
}, total=False)

Unknowns = TypedDict("Unknowns", {
    "magnetization": "UnknownMagnetization", "young": "UnknownYoung", "skin_young": "UnknownYoung",
    "thickness": "UnknownThickness", "fold": "UnknownFold", "natural_strain": "UnknownNaturalStrain",
    "flux_density": "UnknownFluxDensity", "source_strength": "UnknownSourceStrength",
    "source_move": "UnknownSourceMove", "source_turn": "UnknownSourceTurn",
}, total=False)

UnknownMagnetization = TypedDict("UnknownMagnetization", {
    "noise": "Number", "scale": "Number", "bounds": "Numbers", "magnitude": "Number", "max_magnitude": "Number",
    "per": "Literal['face', 'group', 'body']", "groups": "Numbers", "start": "Magnetization",
}, total=False)

UnknownYoung = TypedDict("UnknownYoung", {
    "bounds": "Numbers", "scale": "Literal['log', 'linear']", "noise": "Number",
    "per": "Literal['face', 'group', 'body']", "groups": "Numbers", "start": "Young",
}, total=False)

UnknownThickness = TypedDict("UnknownThickness", {
    "bounds": "Numbers", "scale": "Literal['log', 'linear']", "noise": "Number",
    "per": "Literal['face', 'group', 'body']", "groups": "Numbers", "start": "Thickness",
}, total=False)

UnknownFold = TypedDict("UnknownFold", {
    "bounds": "Numbers", "scale": "Literal['log', 'linear']", "noise": "float",
    "per": "Literal['edge', 'group', 'body']", "groups": "Numbers", "start": "Fold",
}, total=False)

UnknownNaturalStrain = TypedDict("UnknownNaturalStrain", {
    "noise": "Number", "scale": "Number", "bounds": "Numbers",
}, total=False)

UnknownFluxDensity = TypedDict("UnknownFluxDensity", {
    "per": "Literal['frame', 'knot', 'harmonic']", "knots": "int", "harmonics": "int", "noise": "Number",
    "scale": "Number", "bounds": "Numbers", "start": "StartOfFluxDensity",
}, total=False)

StartOfFluxDensityKeys = TypedDict("StartOfFluxDensityKeys", {
    "value": "Numbers", "file": "str",
}, total=False)

UnknownSourceStrength = TypedDict("UnknownSourceStrength", {
    "sources": "Numbers", "noise": "float", "scale": "float", "bounds": "Numbers",
    "per": "Literal['frame', 'knot', 'harmonic']", "knots": "int", "harmonics": "int",
}, total=False)

UnknownSourceMove = TypedDict("UnknownSourceMove", {
    "sources": "Numbers", "noise": "Number", "scale": "Number", "bounds": "Numbers",
}, total=False)

UnknownSourceTurn = TypedDict("UnknownSourceTurn", {
    "sources": "Numbers", "noise": "Number", "scale": "Number", "bounds": "Numbers",
}, total=False)

Objectives = TypedDict("Objectives", {
    "target": "float", "height": "float", "magnetization_smoothness": "float", "young_smoothness": "float",
    "thickness_smoothness": "float", "fold_smoothness": "float", "waypoint": "Waypoint", "curve": "Curve",
    "reach": "Reach", "field_magnitude": "float", "field_smoothness": "float", "dmp": "float", "weight": "float",
    "of": "Number", "at": "Number", "frame": "int", "frames": "Union[int, Numbers]", "pairs": "int",
}, total=False)

Waypoint = TypedDict("Waypoint", {
    "vertex": "Number", "mass_center": "bool", "frame": "int", "frames": "Union[int, Numbers]", "at": "Numbers",
}, total=False)

Curve = TypedDict("Curve", {
    "vertex": "Number", "mass_center": "bool", "frame": "int", "frames": "Union[int, Numbers]", "points": "Table",
    "arc": "Table", "blend": "Number",
}, total=False)

Reach = TypedDict("Reach", {
    "vertex": "Number", "mass_center": "bool", "targets": "Table", "every": "Number", "delay": "Number",
}, total=False)

Solver = TypedDict("Solver", {
    "max_iterations": "int", "step_tolerance": "float", "force_tolerance": "float",
    "direct": "Literal['cholmod', 'mumps']",
}, total=False)

LoadStepsKeys = TypedDict("LoadStepsKeys", {
    "mode": "Literal['auto']", "count": "int", "frames": "bool",
}, total=False)

TimeKeys = TypedDict("TimeKeys", {
    "at": "Number", "step": "Number", "steps": "int",
}, total=False)

StartKeys = TypedDict("StartKeys", {
    "result": "str", "frame": "FrameOfAStart", "case": "Number",
}, total=False)

FrameOfAStartKeys = TypedDict("FrameOfAStartKeys", {
    "mode": "Literal['last']", "number": "int",
}, total=False)

Output = TypedDict("Output", {
    "every": "int", "film": "int", "precision": "Literal['single', 'double']", "states": "Literal['last', 'all']",
    "stress": "bool", "svg": "Number", "png": "Number", "gcode": "Number", "gcode_servo": "Number", "hpgl": "Number",
    "plotter": "Number",
}, total=False)

Scene = TypedDict("Scene", {
    "slender": "Literal[1]",
    "job": "Literal['equilibrium', 'evaluate', 'design', 'simulate', 'trajectory', 'invert', 'identify', 'draw']",
    "shell": "Shell", "rod": "Rod", "solid": "Solid", "spline": "Spline",
    "flux_density": "Union[FluxDensity, Rows[FluxDensity]]", "fix": "Rows[Fix]", "loads": "Rows[Loads]",
    "target": "Union[Target, Rows[Target]]", "obstacles": "Rows[Obstacles]", "contact": "Contact", "water": "Water",
    "cases": "Rows[Cases]", "sequence": "Sequence", "probes": "Mapping[str, Probes]", "design": "Design",
    "solver": "Solver", "load_steps": "LoadSteps", "time": "Time", "start": "Start", "modes": "int",
    "checks": "Union[Literal['stability', 'self_contact', 'round_trip'], Rows[Literal['stability', 'self_contact', 'round_trip']]]",
    "output": "Output",
}, total=False)

Mesh = Union["MeshKeys", str]
Pose = Union["PoseKeys", str, Numbers]
Where = Union["WhereKeys", Number]
Velocity = Union["VelocityKeys", Numbers]
Thickness = Union["ThicknessKeys", Number]
ThicknessOfAGroup = Union["ThicknessOfAGroupKeys", Number]
Young = Union["YoungKeys", Number]
YoungOfAGroup = Union["YoungOfAGroupKeys", Number]
Density = Union["DensityKeys", Number]
DensityOfAGroup = Union["DensityOfAGroupKeys", Number]
Fold = Union["FoldKeys", Number]
FoldOfAGroup = Union["FoldOfAGroupKeys", float]
Magnetization = Union["MagnetizationKeys", Numbers]
MagnetizationOfAGroup = Union["MagnetizationOfAGroupKeys", Numbers]
Noise = Union["NoiseKeys", Literal['auto'], Number]
NaturalStrain = Union["NaturalStrainKeys", Numbers]
Path = Union["PathKeys", Numbers]
LengthAlongARod = Union["LengthAlongARodKeys", Number]
AreaAlongARod = Union["AreaAlongARodKeys", Number]
MomentOfAreaAlongARod = Union["MomentOfAreaAlongARodKeys", Number]
YoungAlongARod = Union["YoungAlongARodKeys", Number]
Frame = Union["FrameKeys", Literal['frenet', 'bishop']]
PointOfALoad = Union["PointOfALoadKeys", Literal['end'], Number]
LineLoadOfARod = Union["LineLoadOfARodKeys", Numbers]
ForceOnARod = Union["ForceOnARodKeys", Numbers]
CoupleOnARod = Union["CoupleOnARodKeys", Numbers]
MeshOfASolid = Union["MeshOfASolidKeys", str]
PlaceOfASkin = Union["PlaceOfASkinKeys", Number]
DensityOfADrawing = Union["DensityOfADrawingKeys", Number]
SizeOfAPage = Union["SizeOfAPageKeys", Number, Numbers]
Pens = Union["PensKeys", Number]
Separation = Union["SeparationKeys", Literal['cmyk', 'tones', 'match']]
Direction = Union["DirectionKeys", Literal['structure_tensor'], Number]
Contours = Union["ContoursKeys", Literal['edges', 'outlines']]
StartOfADrawing = Union["StartOfADrawingKeys", Literal['streamlines', 'random']]
Potential = Union["PotentialKeys", Number]
Flow = Union["FlowKeys", Numbers]
FluxDensity = Union["FluxDensityKeys", Numbers]
Fix = Union["FixKeys", Number]
Selection = Union["SelectionKeys", Number]
Target = Union["TargetKeys", Numbers]
MeshOfAnObstacle = Union["MeshOfAnObstacleKeys", str]
SelfContact = Union["SelfContactKeys", bool]
StiffnessOfContact = Union["StiffnessOfContactKeys", Literal['auto'], Number]
OffsetOfContact = Union["OffsetOfContactKeys", Literal['auto'], Number]
VelocityOfWater = Union["VelocityOfWaterKeys", Numbers]
Sequence = Union["SequenceKeys", Rows["Stages"]]
ForceOfAProbe = Union["ForceOfAProbeKeys", Number]
StartOfFluxDensity = Union["StartOfFluxDensityKeys", Numbers]
LoadSteps = Union["LoadStepsKeys", Literal['auto'], int]
Time = Union["TimeKeys", Number]
Start = Union["StartKeys", str]
FrameOfAStart = Union["FrameOfAStartKeys", Literal['last'], int]
