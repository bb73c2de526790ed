#include "cluster/mpi/mpi_transport.hpp"

#include <mpi.h>

#include <algorithm>
#include <limits>
#include <list>
#include <stdexcept>

namespace credence {

namespace {

/// MPI's own errors end the job, which is MPI's default.
class MpiTransport : public Transport {
public:
    MpiTransport() {
        int provided = 0;
        MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
        if (provided < MPI_THREAD_FUNNELED) throw std::runtime_error("this MPI cannot be used beside threads");
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &size_);
    }
    ~MpiTransport() override {
        if (abandoned_) return;  // the launcher ends a job in which a process ended without MPI_Finalize
        for (Sent& sent : on_the_way_) MPI_Wait(&sent.request, MPI_STATUS_IGNORE);
        MPI_Finalize();
    }
    MpiTransport(const MpiTransport&) = delete;
    MpiTransport& operator=(const MpiTransport&) = delete;

    int rank() const override { return rank_; }
    int size() const override { return size_; }

    void send(int rank, Word word, std::string bytes) override {
        if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
            throw std::length_error("a message of more than 2 GB");
        Sent& sent = on_the_way_.emplace_back(Sent{std::move(bytes), MPI_REQUEST_NULL});
        MPI_Isend(sent.bytes.data(), static_cast<int>(sent.bytes.size()), MPI_BYTE, rank, static_cast<int>(word),
                  MPI_COMM_WORLD, &sent.request);
        sending();
    }

    std::optional<Message> receive() override {
        int there = 0;
        MPI_Status status;
        MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
        if (there == 0) return std::nullopt;
        int size = 0;
        MPI_Get_count(&status, MPI_BYTE, &size);
        Message message{status.MPI_SOURCE, static_cast<Word>(status.MPI_TAG),
                        std::string(static_cast<std::size_t>(size), '\0')};
        MPI_Recv(message.bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
        return message;
    }

    bool sending() override {
        on_the_way_.remove_if([](Sent& sent) {
            int done = 0;
            MPI_Test(&sent.request, &done, MPI_STATUS_IGNORE);
            return done != 0;
        });
        return !on_the_way_.empty();
    }

    void abandon() override { abandoned_ = true; }

private:
    /// The bytes must stay in place until MPI has sent them.
    struct Sent {
        std::string bytes;
        MPI_Request request;
    };

    int rank_ = 0, size_ = 1;
    std::list<Sent> on_the_way_;
    bool abandoned_ = false;
};

}  // namespace

std::unique_ptr<Transport> start_mpi() {
    int before = 0;
    MPI_Initialized(&before);
    return before == 0 ? std::make_unique<MpiTransport>() : nullptr;
}

std::string mpi_library() {
    char text[MPI_MAX_LIBRARY_VERSION_STRING];
    int length = 0;
    MPI_Get_library_version(text, &length);
    const std::string version(text, static_cast<std::size_t>(length));
    return version.substr(0, version.find_first_of(",\n"));
}

}  // namespace credence
