"""Writes the small files of this folder: one trial in every format that is read, by the format's own tools.

    pip install numpy scipy pandas pyarrow mcap mcap-ros2-support mujoco
    python make.py

The trial: 50 instants at 100 Hz, position 0.01 t, force 3 + t, effort 2 t, and in MCAP the force on another clock.
"""

import json
import pathlib

import mcap.writer
import mcap_ros2.writer
import numpy as np
import pandas as pd
import scipy.io

HERE = pathlib.Path(__file__).parent
TIME = np.arange(50) * 0.01
TRIAL = {"t_s": TIME, "position_m": 0.01 * TIME, "force_N": 3 + TIME, "effort_N": 2 * TIME}

JOINT_STATE = """std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
"""
WRENCH = """std_msgs/Header header
geometry_msgs/Wrench wrench
================================================================================
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3 force
geometry_msgs/Vector3 torque
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
"""


def stamp(seconds):
    nanoseconds = round(seconds * 1e9)
    return {"sec": 1_700_000_000 + nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}


def bag(path, compression):
    with open(path, "wb") as stream:
        writer = mcap_ros2.writer.Writer(stream, compression=compression)
        joints = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE)
        wrench = writer.register_msgdef("geometry_msgs/msg/WrenchStamped", WRENCH)
        text = writer.register_msgdef("std_msgs/msg/String", "string data")
        writer.write_message("/note", text, {"data": "not a number"}, log_time=0)
        for t in TIME:
            names = ["elbow", "wrist"]
            message = {"header": {"stamp": stamp(t), "frame_id": "base"}, "name": names,
                       "position": [0.01 * t, -t], "velocity": [], "effort": [2 * t, 0.5]}
            writer.write_message("/joint_states", joints, message, log_time=round(t * 1e9))
            late = t + 0.003
            message = {"header": {"stamp": stamp(late), "frame_id": "tool"},
                       "wrench": {"force": {"x": 0.0, "y": 0.0, "z": 3 + late}, "torque": {"x": 0.0, "y": 0.0, "z": 0.0}}}
            writer.write_message("/wrench", wrench, message, log_time=round(late * 1e9))
        writer.finish()


def main():
    np.savez_compressed(HERE / "trial.npz", **TRIAL)
    data = np.stack([TRIAL["position_m"], TRIAL["effort_N"], TRIAL["force_N"]], axis=1)
    mapping = {"slide_pos": [0, [0]], "motor": [5, [1]], "touch": [0, [2]]}
    np.savez(HERE / "sysid.npz", times=TIME, data=data, signal_mapping=np.asarray(json.dumps(mapping)))
    np.savez(HERE / "object.npz", **{**TRIAL, "force_N": np.array([{}] * 50, dtype=object)})
    np.savez(HERE / "unequal.npz", **{**TRIAL, "force_N": TRIAL["force_N"][:-1]})
    nan = TRIAL["force_N"].copy()
    nan[7] = np.nan
    np.savez(HERE / "nan.npz", **{**TRIAL, "force_N": nan})
    scipy.io.savemat(HERE / "trial.mat", {**TRIAL, "both": data[:, :2].T, "config": {"gain": 1.0}}, do_compression=True)
    scipy.io.savemat(HERE / "plain.mat", TRIAL)
    frame = pd.DataFrame({**TRIAL, "note": ["a"] * 50})
    frame.to_parquet(HERE / "trial.parquet", compression="snappy")
    frame.to_parquet(HERE / "zstd.parquet", compression="zstd")
    bag(HERE / "trial.mcap", mcap_ros2.writer.CompressionType.ZSTD)
    bag(HERE / "lz4.mcap", mcap_ros2.writer.CompressionType.LZ4)
    bag(HERE / "plain.mcap", mcap_ros2.writer.CompressionType.NONE)


if __name__ == "__main__":
    main()
