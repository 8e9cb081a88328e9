"""Case files: strict text -> validated document -> structure and settings."""
