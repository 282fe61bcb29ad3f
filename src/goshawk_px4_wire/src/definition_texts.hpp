#pragma once

#include <string_view>

/// The fields of PX4's messages in their order on the wire, named after the first release that has
/// them so (PX4/px4_msgs, branches release/1.15 to release/1.18).
namespace goshawk::px4 {

inline constexpr std::string_view kVehicleOdometry_1_15 =
    "uint64 timestamp; uint64 timestamp_sample; uint8 pose_frame; float32[3] position; "
    "float32[4] q; uint8 velocity_frame; float32[3] velocity; float32[3] "
    "angular_velocity; float32[3] position_variance; float32[3] orientation_variance; "
    "float32[3] velocity_variance; uint8 reset_counter; int8 quality";

inline constexpr std::string_view kVehicleLocalPosition_1_15 =
    "uint64 timestamp; uint64 timestamp_sample; bool xy_valid; bool z_valid; bool "
    "v_xy_valid; bool v_z_valid; float32 x; float32 y; float32 z; float32[2] delta_xy; "
    "uint8 xy_reset_counter; float32 delta_z; uint8 z_reset_counter; float32 vx; float32 "
    "vy; float32 vz; float32 z_deriv; float32[2] delta_vxy; uint8 vxy_reset_counter; "
    "float32 delta_vz; uint8 vz_reset_counter; float32 ax; float32 ay; float32 az; "
    "float32 heading; float32 heading_var; float32 unaided_heading; float32 "
    "delta_heading; uint8 heading_reset_counter; bool heading_good_for_control; float32 "
    "tilt_var; bool xy_global; bool z_global; uint64 ref_timestamp; float64 ref_lat; "
    "float64 ref_lon; float32 ref_alt; float32 dist_bottom; bool dist_bottom_valid; uint8 "
    "dist_bottom_sensor_bitfield; float32 eph; float32 epv; float32 evh; float32 evv; "
    "bool dead_reckoning; float32 vxy_max; float32 vz_max; float32 hagl_min; float32 "
    "hagl_max";

inline constexpr std::string_view kVehicleLocalPosition_1_16 =
    "uint64 timestamp; uint64 timestamp_sample; bool xy_valid; bool z_valid; bool "
    "v_xy_valid; bool v_z_valid; float32 x; float32 y; float32 z; float32[2] delta_xy; "
    "uint8 xy_reset_counter; float32 delta_z; uint8 z_reset_counter; float32 vx; float32 "
    "vy; float32 vz; float32 z_deriv; float32[2] delta_vxy; uint8 vxy_reset_counter; "
    "float32 delta_vz; uint8 vz_reset_counter; float32 ax; float32 ay; float32 az; "
    "float32 heading; float32 heading_var; float32 unaided_heading; float32 "
    "delta_heading; uint8 heading_reset_counter; bool heading_good_for_control; float32 "
    "tilt_var; bool xy_global; bool z_global; uint64 ref_timestamp; float64 ref_lat; "
    "float64 ref_lon; float32 ref_alt; bool dist_bottom_valid; float32 dist_bottom; "
    "float32 dist_bottom_var; float32 delta_dist_bottom; uint8 dist_bottom_reset_counter; "
    "uint8 dist_bottom_sensor_bitfield; float32 eph; float32 epv; float32 evh; float32 "
    "evv; bool dead_reckoning; float32 vxy_max; float32 vz_max; float32 hagl_min; float32 "
    "hagl_max_z; float32 hagl_max_xy";

inline constexpr std::string_view kVehicleStatus_1_15 =
    "uint64 timestamp; uint64 armed_time; uint64 takeoff_time; uint8 arming_state; uint8 "
    "latest_arming_reason; uint8 latest_disarming_reason; uint64 nav_state_timestamp; "
    "uint8 nav_state_user_intention; uint8 nav_state; uint8 executor_in_charge; uint32 "
    "valid_nav_states_mask; uint32 can_set_nav_states_mask; uint16 "
    "failure_detector_status; uint8 hil_state; uint8 vehicle_type; bool failsafe; bool "
    "failsafe_and_user_took_over; uint8 failsafe_defer_state; bool gcs_connection_lost; "
    "uint8 gcs_connection_lost_counter; bool high_latency_data_link_lost; bool is_vtol; "
    "bool is_vtol_tailsitter; bool in_transition_mode; bool in_transition_to_fw; uint8 "
    "system_type; uint8 system_id; uint8 component_id; bool safety_button_available; bool "
    "safety_off; bool power_input_valid; bool usb_connected; bool "
    "open_drone_id_system_present; bool open_drone_id_system_healthy; bool "
    "parachute_system_present; bool parachute_system_healthy; bool "
    "avoidance_system_required; bool avoidance_system_valid; bool "
    "rc_calibration_in_progress; bool calibration_enabled; bool pre_flight_checks_pass";

inline constexpr std::string_view kVehicleStatus_1_16 =
    "uint64 timestamp; uint64 armed_time; uint64 takeoff_time; uint8 arming_state; uint8 "
    "latest_arming_reason; uint8 latest_disarming_reason; uint64 nav_state_timestamp; "
    "uint8 nav_state_user_intention; uint8 nav_state; uint8 executor_in_charge; uint32 "
    "valid_nav_states_mask; uint32 can_set_nav_states_mask; uint16 "
    "failure_detector_status; uint8 hil_state; uint8 vehicle_type; bool failsafe; bool "
    "failsafe_and_user_took_over; uint8 failsafe_defer_state; bool gcs_connection_lost; "
    "uint8 gcs_connection_lost_counter; bool high_latency_data_link_lost; bool is_vtol; "
    "bool is_vtol_tailsitter; bool in_transition_mode; bool in_transition_to_fw; uint8 "
    "system_type; uint8 system_id; uint8 component_id; bool safety_button_available; bool "
    "safety_off; bool power_input_valid; bool usb_connected; bool "
    "open_drone_id_system_present; bool open_drone_id_system_healthy; bool "
    "parachute_system_present; bool parachute_system_healthy; bool "
    "rc_calibration_in_progress; bool calibration_enabled; bool pre_flight_checks_pass";

inline constexpr std::string_view kVehicleStatus_1_18 =
    "uint64 timestamp; uint64 armed_time; uint64 takeoff_time; uint8 arming_state; uint8 "
    "latest_arming_reason; uint8 latest_disarming_reason; uint64 nav_state_timestamp; "
    "uint8 nav_state_user_intention; uint8 nav_state; uint8 executor_in_charge; uint8 "
    "nav_state_display; bool accepts_offboard_setpoints; uint32 valid_nav_states_mask; "
    "uint32 can_set_nav_states_mask; uint8 hil_state; uint8 vehicle_type; bool failsafe; "
    "bool failsafe_and_user_took_over; uint8 failsafe_defer_state; bool "
    "gcs_connection_lost; uint8 gcs_connection_lost_counter; bool "
    "high_latency_data_link_lost; bool is_vtol; bool is_vtol_tailsitter; bool "
    "in_transition_mode; bool in_transition_to_fw; uint8 system_type; uint8 system_id; "
    "uint8 component_id; bool safety_button_available; bool safety_off; bool "
    "power_input_valid; bool usb_connected; bool open_drone_id_system_present; bool "
    "open_drone_id_system_healthy; bool parachute_system_present; bool "
    "parachute_system_healthy; bool traffic_avoidance_system_present; bool "
    "rc_calibration_in_progress; bool calibration_enabled; bool pre_flight_checks_pass";

inline constexpr std::string_view kVehicleLandDetected_1_15 =
    "uint64 timestamp; bool freefall; bool ground_contact; bool maybe_landed; bool "
    "landed; bool in_ground_effect; bool in_descend; bool has_low_throttle; bool "
    "vertical_movement; bool horizontal_movement; bool rotational_movement; bool "
    "close_to_ground_or_skipped_check; bool at_rest";

inline constexpr std::string_view kBatteryStatus_1_15 =
    "uint64 timestamp; bool connected; float32 voltage_v; float32 voltage_filtered_v; "
    "float32 current_a; float32 current_filtered_a; float32 current_average_a; float32 "
    "discharged_mah; float32 remaining; float32 scale; float32 time_remaining_s; float32 "
    "temperature; uint8 cell_count; uint8 source; uint8 priority; uint16 capacity; uint16 "
    "cycle_count; uint16 average_time_to_empty; uint16 serial_number; uint16 "
    "manufacture_date; uint16 state_of_health; uint16 max_error; uint8 id; uint16 "
    "interface_error; float32[14] voltage_cell_v; float32 max_cell_voltage_delta; bool "
    "is_powering_off; bool is_required; uint16 faults; uint32 custom_faults; uint8 "
    "warning; uint8 mode; float32 average_power; float32 available_energy; float32 "
    "full_charge_capacity_wh; float32 remaining_capacity_wh; float32 design_capacity; "
    "uint16 average_time_to_full; uint16 over_discharge_count; float32 nominal_voltage";

inline constexpr std::string_view kBatteryStatus_1_16 =
    "uint64 timestamp; bool connected; float32 voltage_v; float32 current_a; float32 "
    "current_average_a; float32 discharged_mah; float32 remaining; float32 scale; float32 "
    "time_remaining_s; float32 temperature; uint8 cell_count; uint8 source; uint8 "
    "priority; uint16 capacity; uint16 cycle_count; uint16 average_time_to_empty; uint16 "
    "serial_number; uint16 manufacture_date; uint16 state_of_health; uint16 max_error; "
    "uint8 id; uint16 interface_error; float32[14] voltage_cell_v; float32 "
    "max_cell_voltage_delta; bool is_powering_off; bool is_required; uint16 faults; uint8 "
    "warning; float32 full_charge_capacity_wh; float32 remaining_capacity_wh; uint16 "
    "over_discharge_count; float32 nominal_voltage; float32 internal_resistance_estimate; "
    "float32 ocv_estimate; float32 ocv_estimate_filtered; float32 "
    "volt_based_soc_estimate; float32 voltage_prediction; float32 prediction_error; "
    "float32 estimation_covariance_norm";

inline constexpr std::string_view kBatteryStatus_1_17 =
    "uint64 timestamp; bool connected; float32 voltage_v; float32 current_a; float32 "
    "current_average_a; float32 discharged_mah; float32 remaining; float32 scale; float32 "
    "time_remaining_s; float32 temperature; uint8 cell_count; uint8 source; uint8 "
    "priority; uint16 capacity; uint16 cycle_count; uint16 average_time_to_empty; uint16 "
    "manufacture_date; uint16 state_of_health; uint16 max_error; uint8 id; uint16 "
    "interface_error; float32[14] voltage_cell_v; float32 max_cell_voltage_delta; bool "
    "is_powering_off; bool is_required; uint8 warning; uint16 faults; float32 "
    "full_charge_capacity_wh; float32 remaining_capacity_wh; uint16 over_discharge_count; "
    "float32 nominal_voltage; float32 internal_resistance_estimate; float32 ocv_estimate; "
    "float32 ocv_estimate_filtered; float32 volt_based_soc_estimate; float32 "
    "voltage_prediction; float32 prediction_error; float32 estimation_covariance_norm";

inline constexpr std::string_view kFailsafeFlags_1_15 =
    "uint64 timestamp; uint32 mode_req_angular_velocity; uint32 mode_req_attitude; uint32 "
    "mode_req_local_alt; uint32 mode_req_local_position; uint32 "
    "mode_req_local_position_relaxed; uint32 mode_req_global_position; uint32 "
    "mode_req_mission; uint32 mode_req_offboard_signal; uint32 mode_req_home_position; "
    "uint32 mode_req_wind_and_flight_time_compliance; uint32 mode_req_prevent_arming; "
    "uint32 mode_req_manual_control; uint32 mode_req_other; bool "
    "angular_velocity_invalid; bool attitude_invalid; bool local_altitude_invalid; bool "
    "local_position_invalid; bool local_position_invalid_relaxed; bool "
    "local_velocity_invalid; bool global_position_invalid; bool auto_mission_missing; "
    "bool offboard_control_signal_lost; bool home_position_invalid; bool "
    "manual_control_signal_lost; bool gcs_connection_lost; uint8 battery_warning; bool "
    "battery_low_remaining_time; bool battery_unhealthy; bool geofence_breached; bool "
    "mission_failure; bool vtol_fixed_wing_system_failure; bool wind_limit_exceeded; bool "
    "flight_time_limit_exceeded; bool local_position_accuracy_low; bool "
    "fd_critical_failure; bool fd_esc_arming_failure; bool fd_imbalanced_prop; bool "
    "fd_motor_failure";

inline constexpr std::string_view kFailsafeFlags_1_16 =
    "uint64 timestamp; uint32 mode_req_angular_velocity; uint32 mode_req_attitude; uint32 "
    "mode_req_local_alt; uint32 mode_req_local_position; uint32 "
    "mode_req_local_position_relaxed; uint32 mode_req_global_position; uint32 "
    "mode_req_mission; uint32 mode_req_offboard_signal; uint32 mode_req_home_position; "
    "uint32 mode_req_wind_and_flight_time_compliance; uint32 mode_req_prevent_arming; "
    "uint32 mode_req_manual_control; uint32 mode_req_other; bool "
    "angular_velocity_invalid; bool attitude_invalid; bool local_altitude_invalid; bool "
    "local_position_invalid; bool local_position_invalid_relaxed; bool "
    "local_velocity_invalid; bool global_position_invalid; bool auto_mission_missing; "
    "bool offboard_control_signal_lost; bool home_position_invalid; bool "
    "manual_control_signal_lost; bool gcs_connection_lost; uint8 battery_warning; bool "
    "battery_low_remaining_time; bool battery_unhealthy; bool geofence_breached; bool "
    "mission_failure; bool vtol_fixed_wing_system_failure; bool wind_limit_exceeded; bool "
    "flight_time_limit_exceeded; bool local_position_accuracy_low; bool "
    "navigator_failure; bool fd_critical_failure; bool fd_esc_arming_failure; bool "
    "fd_imbalanced_prop; bool fd_motor_failure";

inline constexpr std::string_view kFailsafeFlags_1_17 =
    "uint64 timestamp; uint32 mode_req_angular_velocity; uint32 mode_req_attitude; uint32 "
    "mode_req_local_alt; uint32 mode_req_local_position; uint32 "
    "mode_req_local_position_relaxed; uint32 mode_req_global_position; uint32 "
    "mode_req_global_position_relaxed; uint32 mode_req_mission; uint32 "
    "mode_req_offboard_signal; uint32 mode_req_home_position; uint32 "
    "mode_req_wind_and_flight_time_compliance; uint32 mode_req_prevent_arming; uint32 "
    "mode_req_manual_control; uint32 mode_req_other; bool angular_velocity_invalid; bool "
    "attitude_invalid; bool local_altitude_invalid; bool local_position_invalid; bool "
    "local_position_invalid_relaxed; bool local_velocity_invalid; bool "
    "global_position_invalid; bool global_position_invalid_relaxed; bool "
    "auto_mission_missing; bool offboard_control_signal_lost; bool home_position_invalid; "
    "bool manual_control_signal_lost; bool gcs_connection_lost; uint8 battery_warning; "
    "bool battery_low_remaining_time; bool battery_unhealthy; bool geofence_breached; "
    "bool mission_failure; bool vtol_fixed_wing_system_failure; bool wind_limit_exceeded; "
    "bool flight_time_limit_exceeded; bool position_accuracy_low; bool navigator_failure; "
    "bool fd_critical_failure; bool fd_esc_arming_failure; bool fd_imbalanced_prop; bool "
    "fd_motor_failure";

inline constexpr std::string_view kFailsafeFlags_1_18 =
    "uint64 timestamp; uint32 mode_req_angular_velocity; uint32 mode_req_attitude; uint32 "
    "mode_req_local_alt; uint32 mode_req_local_position; uint32 "
    "mode_req_local_position_relaxed; uint32 mode_req_global_position; uint32 "
    "mode_req_global_position_relaxed; uint32 mode_req_mission; uint32 "
    "mode_req_offboard_signal; uint32 mode_req_home_position; uint32 "
    "mode_req_wind_and_flight_time_compliance; uint32 mode_req_prevent_arming; uint32 "
    "mode_req_manual_control; uint32 mode_req_other; bool angular_velocity_invalid; bool "
    "attitude_invalid; bool local_altitude_invalid; bool local_position_invalid; bool "
    "local_position_invalid_relaxed; bool local_velocity_invalid; bool "
    "global_position_invalid; bool global_position_invalid_relaxed; bool "
    "auto_mission_missing; bool offboard_control_signal_lost; bool home_position_invalid; "
    "bool manual_control_signal_lost; bool gcs_connection_lost; uint8 battery_warning; "
    "bool battery_low_remaining_time; bool battery_unhealthy; bool fd_critical_failure; "
    "bool fd_esc_arming_failure; bool fd_imbalanced_prop; bool fd_motor_failure; bool "
    "fd_alt_loss; bool geofence_breached; bool mission_failure; bool "
    "vtol_fixed_wing_system_failure; bool wind_limit_exceeded; bool "
    "flight_time_limit_exceeded; bool position_accuracy_low; bool navigator_failure; bool "
    "parachute_unhealthy; bool remote_id_unhealthy; bool gnss_lost";

inline constexpr std::string_view kManualControlSetpoint_1_15 =
    "uint64 timestamp; uint64 timestamp_sample; bool valid; uint8 data_source; float32 "
    "roll; float32 pitch; float32 yaw; float32 throttle; float32 flaps; float32 aux1; "
    "float32 aux2; float32 aux3; float32 aux4; float32 aux5; float32 aux6; bool "
    "sticks_moving; uint16 buttons";

inline constexpr std::string_view kVehicleCommandAck_1_15 =
    "uint64 timestamp; uint32 command; uint8 result; uint8 result_param1; int32 "
    "result_param2; uint8 target_system; uint16 target_component; bool from_external";

inline constexpr std::string_view kRegisterExtComponentReply_1_15 =
    "uint64 timestamp; uint64 request_id; char[25] name; uint16 px4_ros2_api_version; "
    "bool success; int8 arming_check_id; int8 mode_id; int8 mode_executor_id";

inline constexpr std::string_view kRegisterExtComponentReply_1_18 =
    "uint64 timestamp; uint64 request_id; char[25] name; uint16 px4_ros2_api_version; "
    "bool success; int8 arming_check_id; int8 mode_id; int8 mode_executor_id; bool "
    "not_user_selectable";

inline constexpr std::string_view kArmingCheckRequest_1_15 = "uint64 timestamp; uint8 request_id";

inline constexpr std::string_view kArmingCheckRequest_1_17 =
    "uint64 timestamp; uint8 request_id; uint32 valid_registrations_mask";

inline constexpr std::string_view kMessageFormatResponse_1_15 =
    "uint64 timestamp; uint16 protocol_version; char[50] topic_name; bool success; uint32 "
    "message_hash";

inline constexpr std::string_view kSetpointConfigReply_1_18 =
    "uint64 timestamp; uint16 type; uint8 source_id; uint8 result; bool "
    "mode_req_angular_velocity; bool mode_req_attitude; bool mode_req_local_alt; bool "
    "mode_req_local_position";

inline constexpr std::string_view kVehicleCommand_1_15 =
    "uint64 timestamp; float32 param1; float32 param2; float32 param3; float32 param4; "
    "float64 param5; float64 param6; float32 param7; uint32 command; uint8 target_system; "
    "uint8 target_component; uint8 source_system; uint16 source_component; uint8 "
    "confirmation; bool from_external";

inline constexpr std::string_view kOffboardControlMode_1_15 =
    "uint64 timestamp; bool position; bool velocity; bool acceleration; bool attitude; "
    "bool body_rate; bool thrust_and_torque; bool direct_actuator";

inline constexpr std::string_view kTrajectorySetpoint_1_15 =
    "uint64 timestamp; float32[3] position; float32[3] velocity; float32[3] acceleration; "
    "float32[3] jerk; float32 yaw; float32 yawspeed";

inline constexpr std::string_view kVehicleAttitudeSetpoint_1_15 =
    "uint64 timestamp; float32 roll_body; float32 pitch_body; float32 yaw_body; float32 "
    "yaw_sp_move_rate; float32[4] q_d; float32[3] thrust_body; bool reset_integral; bool "
    "fw_control_yaw_wheel";

inline constexpr std::string_view kVehicleAttitudeSetpoint_1_16 =
    "uint64 timestamp; float32 yaw_sp_move_rate; float32[4] q_d; float32[3] thrust_body; "
    "bool reset_integral; bool fw_control_yaw_wheel";

inline constexpr std::string_view kVehicleAttitudeSetpoint_1_17 =
    "uint64 timestamp; float32 yaw_sp_move_rate; float32[4] q_d; float32[3] thrust_body";

inline constexpr std::string_view kVehicleControlMode_1_15 =
    "uint64 timestamp; bool flag_armed; bool flag_multicopter_position_control_enabled; "
    "bool flag_control_manual_enabled; bool flag_control_auto_enabled; bool "
    "flag_control_offboard_enabled; bool flag_control_position_enabled; bool "
    "flag_control_velocity_enabled; bool flag_control_altitude_enabled; bool "
    "flag_control_climb_rate_enabled; bool flag_control_acceleration_enabled; bool "
    "flag_control_attitude_enabled; bool flag_control_rates_enabled; bool "
    "flag_control_allocation_enabled; bool flag_control_termination_enabled; uint8 "
    "source_id";

inline constexpr std::string_view kVehicleControlMode_1_18 =
    "uint64 timestamp; bool flag_armed; bool flag_multicopter_position_control_enabled; "
    "bool flag_control_manual_enabled; bool flag_control_auto_enabled; bool "
    "flag_control_offboard_enabled; bool flag_control_position_enabled; bool "
    "flag_control_velocity_enabled; bool flag_control_altitude_enabled; bool "
    "flag_control_climb_rate_enabled; bool flag_control_attitude_enabled; bool "
    "flag_control_rates_enabled; bool flag_control_allocation_enabled";

inline constexpr std::string_view kSetpointConfig_1_18 =
    "uint64 timestamp; uint16 type; uint8 source_id; bool should_apply; uint16 timeout_ms";

inline constexpr std::string_view kRegisterExtComponentRequest_1_15 =
    "uint64 timestamp; uint64 request_id; char[25] name; uint16 px4_ros2_api_version; "
    "bool register_arming_check; bool register_mode; bool register_mode_executor; bool "
    "enable_replace_internal_mode; uint8 replace_internal_mode; bool "
    "activate_mode_immediately";

inline constexpr std::string_view kRegisterExtComponentRequest_1_18 =
    "uint64 timestamp; uint64 request_id; char[25] name; uint16 px4_ros2_api_version; "
    "bool register_arming_check; bool register_mode; bool register_mode_executor; bool "
    "enable_replace_internal_mode; uint8 replace_internal_mode; bool "
    "activate_mode_immediately; bool not_user_selectable; bool request_offboard_setpoints";

inline constexpr std::string_view kUnregisterExtComponent_1_15 =
    "uint64 timestamp; char[25] name; int8 arming_check_id; int8 mode_id; int8 "
    "mode_executor_id";

inline constexpr std::string_view kArmingCheckReply_1_15 =
    "uint64 timestamp; uint8 request_id; uint8 registration_id; uint8 "
    "health_component_index; bool health_component_is_present; bool "
    "health_component_warning; bool health_component_error; bool can_arm_and_run; uint8 "
    "num_events; Event[5] events; bool mode_req_angular_velocity; bool mode_req_attitude; "
    "bool mode_req_local_alt; bool mode_req_local_position; bool "
    "mode_req_local_position_relaxed; bool mode_req_global_position; bool "
    "mode_req_mission; bool mode_req_home_position; bool mode_req_prevent_arming; bool "
    "mode_req_manual_control";

inline constexpr std::string_view kArmingCheckReply_1_17 =
    "uint64 timestamp; uint8 request_id; uint8 registration_id; uint8 "
    "health_component_index; bool health_component_is_present; bool "
    "health_component_warning; bool health_component_error; bool can_arm_and_run; uint8 "
    "num_events; Event[5] events; bool mode_req_angular_velocity; bool mode_req_attitude; "
    "bool mode_req_local_alt; bool mode_req_local_position; bool "
    "mode_req_local_position_relaxed; bool mode_req_global_position; bool "
    "mode_req_global_position_relaxed; bool mode_req_mission; bool "
    "mode_req_home_position; bool mode_req_prevent_arming; bool mode_req_manual_control";

inline constexpr std::string_view kMessageFormatRequest_1_15 =
    "uint64 timestamp; uint16 protocol_version; char[50] topic_name";

}  // namespace goshawk::px4
